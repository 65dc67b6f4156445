// listing.cpp - an image as text.
#include <fmt/format.h>

#include <iterator>
#include <span>

#include "host_sim/trace/coverage.hpp"
#include "toolchain/isa/disassemble.hpp"

namespace host_sim {
namespace {

class Lister {
public:
    Lister(const Image& image, const Symbols* symbols, const Coverage& coverage)
        : image_(image), symbols_(symbols), coverage_(coverage) {
        if (symbols_ == nullptr) return;
        how_.address_text = [this](uint16_t address) { return symbols_->describe(address); };
    }

    Listing run() {
        for (std::size_t address = 0; address < kAddressSpaceSize;) {
            if (image_.present[address]) {
                address += one(static_cast<uint16_t>(address));
            } else {
                ++address;
            }
        }
        return std::move(listing_);
    }

private:
    [[nodiscard]] bool is_code(uint16_t address) const {
        if (coverage_.executed(address) != 0 || symbols_ == nullptr) return true;
        return symbols_->function_at(address) != nullptr;
    }

    /// Bytes from `address` on that may form one instruction: present, of one symbol, and without
    /// the start of an executed instruction among them.
    [[nodiscard]] std::size_t room(uint16_t address) const {
        std::size_t size = 1;
        while (size < 3 && address + size < kAddressSpaceSize && image_.present[address + size]) {
            const auto next = static_cast<uint16_t>(address + size);
            const bool executed_here = coverage_.executed(address) != 0;
            if (coverage_.executed(next) != 0 && !executed_here) break;
            if (symbols_ != nullptr && !executed_here &&
                symbols_->at(next) != symbols_->at(address)) {
                break;
            }
            ++size;
        }
        return size;
    }

    void line(uint16_t address, bool code, std::string_view text) {
        listing_.lines.push_back({address, code});
        listing_.text += text;
        listing_.text += '\n';
    }

    /// Writes the line of an address. @return the bytes it covers
    std::size_t one(uint16_t address) {
        const Symbol* symbol = symbols_ == nullptr ? nullptr : symbols_->at(address);
        if (symbol != nullptr && symbol->address == address) {
            line(address, false, symbol->name + ":");
        }
        const bool code = is_code(address);
        toolchain::isa::Disassembly what;
        if (code) {
            what = toolchain::isa::disassemble(
                std::span(image_.bytes).subspan(address, room(address)), how_);
        } else {
            what.text = "DB " + toolchain::isa::intel_hex(image_.bytes[address], 2);
        }
        std::string bytes;
        for (std::size_t i = 0; i < what.bytes; ++i) {
            fmt::format_to(std::back_inserter(bytes), "{:02X} ", image_.bytes[address + i]);
        }
        // A DB that nobody executed is data, or the rest of an instruction that overlaps another.
        const bool instruction =
            code && (coverage_.executed(address) != 0 || !what.text.starts_with("DB "));
        line(address, instruction, fmt::format("{:04X}  {:<9} {}", address, bytes, what.text));
        std::size_t size = what.bytes;
        for (std::size_t i = 1; i < what.bytes; ++i) {
            if (coverage_.executed(static_cast<uint16_t>(address + i)) != 0) {
                size = i;  // overlapping instructions that were both executed
                break;
            }
        }
        return size;
    }

    const Image& image_;
    const Symbols* symbols_;
    const Coverage& coverage_;
    toolchain::isa::DisassembleOptions how_;
    Listing listing_;
};

}  // namespace

Listing make_listing(const Image& image, const Symbols* symbols, const Coverage& coverage) {
    return Lister(image, symbols, coverage).run();
}

}  // namespace host_sim
