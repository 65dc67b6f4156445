#include "tools/i85run/program.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "tools/i85run/cpm.hpp"
#include "tools/i85run/number.hpp"

namespace i85run {
namespace {

using host_sim::Image;
using host_sim::ImageError;
using host_sim::Symbol;

Image load_com(const std::string& file) {
    const std::string content = host_sim::read_image_file(file);
    if (content.size() > kCpmProgramBytesMax) {
        throw ImageError(file, 0,
                         fmt::format("has {} bytes, but a CP/M program has at most {} (0100h to "
                                     "{:04X}h)",
                                     content.size(), kCpmProgramBytesMax, kCpmMemoryTop - 1),
                         "give a .COM program");
    }
    return host_sim::read_bin(content, kCpmProgramStart, file);
}

Image load_image(const Options& options) {
    if (options.cpm) return load_com(options.image);
    if (!options.load_address) return host_sim::load_hex(options.image);
    Image image = host_sim::load_bin(options.image, *options.load_address);
    image.start = options.load_address;
    return image;
}

std::string symbols_file(const Options& options) {
    if (!options.symbols.empty()) return options.symbols;
    const std::string beside = std::filesystem::path(options.image).replace_extension(".sym");
    std::error_code ignored;
    return std::filesystem::exists(beside, ignored) ? beside : std::string();
}

[[noreturn]] void fail_unknown(const Program& program, const std::string& option,
                               const std::string& name) {
    if (program.symbols_file.empty()) {
        throw ImageError(program.image.file, 0,
                         fmt::format("has no symbol file, so {} {} is unknown", option, name),
                         "give --symbols FILE, or an address as 0x8000");
    }
    throw ImageError(program.symbols_file, 0,
                     fmt::format("there is no symbol {} for {}", name, option),
                     "check the name, or give an address as 0x8000");
}

}  // namespace

Program load_program(const Options& options) {
    Program program{load_image(options), {}, symbols_file(options)};
    if (!program.symbols_file.empty()) {
        program.symbols = host_sim::load_symbols(program.symbols_file);
    }
    return program;
}

uint16_t resolve_address(const Program& program, const std::string& option,
                         const std::string& text) {
    if (const Symbol* symbol = program.symbols.find(text)) return symbol->address;
    if (const auto number = parse_number(text, 0xFFFF)) return static_cast<uint16_t>(*number);
    fail_unknown(program, option, text);
}

uint16_t start_address(const Program& program, const Options& options) {
    if (!options.entry.empty()) return resolve_address(program, "--entry", options.entry);
    const Image& image = program.image;
    if (image.start) return *image.start;
    return image.present[0] ? uint16_t{0} : image.extent()->first;
}

DumpPlace resolve_dump(const Program& program, const std::string& text) {
    DumpPlace dump{text, 0, 0};
    if (const Symbol* symbol = program.symbols.find(text)) {
        if (symbol->size == 0) {
            throw ImageError(program.symbols_file, symbol->file_line,
                             fmt::format("{} has no size for --dump", text),
                             fmt::format("write --dump {}:LEN", text));
        }
        dump.address = symbol->address;
        dump.length = symbol->size;
        return dump;
    }
    const auto place = parse_place(text);
    if (!place || !place->length) fail_unknown(program, "--dump", text);
    dump.address = resolve_address(program, "--dump", std::string(place->place));
    dump.length = *place->length;
    if (dump.address + dump.length > host_sim::kAddressSpaceSize) {
        throw UsageError(fmt::format("--dump {}: goes beyond FFFFh; {} bytes are left there", text,
                                     host_sim::kAddressSpaceSize - dump.address));
    }
    return dump;
}

}  // namespace i85run
