// flasher.cpp - see flasher.hpp.
#include "host_sim/bind/flasher.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace host_sim {
namespace {

using rover::loader::kApplicationFirst;
using rover::loader::kChecksMax;
using rover::loader::kPageSize;
using rover::loader::kRecordPage;
using rover::loader::Result;

constexpr unsigned kWritesOfAPage = 3;

/// The board was reset meanwhile: it has to be opened again.
struct Reopen {};

/// An image as pages.
class Pages {
public:
    explicit Pages(const Image& image)
        : identity_(read_identity(image)), bytes_(application_pages(image, identity_)) {}

    [[nodiscard]] const ImageIdentity& identity() const { return identity_; }
    [[nodiscard]] std::size_t count() const { return bytes_.size() / kPageSize; }
    [[nodiscard]] std::span<const uint8_t> page(std::size_t index) const {
        return std::span(bytes_).subspan(index * kPageSize, kPageSize);
    }
    static uint16_t address(std::size_t index) {
        return static_cast<uint16_t>(kApplicationFirst + index * kPageSize);
    }

private:
    ImageIdentity identity_;
    std::vector<uint8_t> bytes_;
};

using Progress = std::function<void(const FlashProgress&)>;

void tell(const Progress& progress, const char* what, std::size_t done, std::size_t all) {
    if (progress) progress({what, done, all});
}

/// Pages whose check is another one in the board.
std::vector<std::size_t> different_pages(LoaderClient& client, const Pages& pages,
                                         const Progress& progress, const char* what) {
    std::vector<std::size_t> different;
    for (std::size_t first = 0; first < pages.count(); first += kChecksMax) {
        tell(progress, what, first, pages.count());
        const auto count =
            static_cast<uint8_t>(std::min<std::size_t>(kChecksMax, pages.count() - first));
        const auto checks = client.check(Pages::address(first), count);
        for (std::size_t i = 0; i < count; ++i) {
            if (checks[i] != link_crc(pages.page(first + i))) different.push_back(first + i);
        }
    }
    tell(progress, what, pages.count(), pages.count());
    return different;
}

[[noreturn]] void fail_write(const LoaderReport& report, uint16_t address) {
    if (report.result == Result::no_end) {
        throw FlashError(fmt::format(
            "the EEPROM does not end its write cycle at {:04X}H; check its supply and WE, or "
            "replace the part",
            report.address));
    }
    if (report.result == Result::differs) {
        throw FlashError(
            fmt::format("{:04X}H reads {:02X}H instead of {:02X}H behind {} writes; {}",
                        report.address, report.found, report.expected, kWritesOfAPage,
                        likely_cause(std::span(&report.expected, 1), std::span(&report.found, 1))));
    }
    throw FlashError(
        fmt::format("the loader refuses page {:04X}H (result {}); use the rover85 of "
                    "the loader's version",
                    address, static_cast<int>(report.result)));
}

void write_page(LoaderClient& client, uint16_t address, std::span<const uint8_t> page) {
    LoaderReport report;
    for (unsigned i = 0; i < kWritesOfAPage; ++i) {
        report = client.write(address, page);
        if (report.result == Result::done) return;
        if (report.result == Result::not_open) throw Reopen{};
        if (report.result != Result::differs) break;
    }
    fail_write(report, address);
}

void open(LoaderClient& client) {
    const LoaderReport report = client.open();
    if (report.result != Result::done) fail_write(report, kRecordPage);
}

void close(LoaderClient& client, const Pages& pages) {
    const LoaderReport report = client.close(pages.identity().address);
    if (report.result == Result::done) return;
    if (report.result == Result::not_open) throw Reopen{};
    if (report.result == Result::wrong_crc) {
        throw FlashError(fmt::format(
            "the board's image has the CRC-16 {:04X}H instead of {:04X}H though every page was "
            "verified; run the command again with --all",
            report.address, pages.identity().image_crc));
    }
    fail_write(report, pages.identity().address);
}

void check_vehicle(const LoaderHello& hello, const Pages& pages) {
    const std::string& vehicle = pages.identity().vehicle;
    if (!hello.identity || hello.identity->vehicle == vehicle) return;
    throw FlashError(
        fmt::format("the board has an image for the vehicle {}, this one is for {}; "
                    "add --any-vehicle if it is meant",
                    hello.identity->vehicle, vehicle));
}

void check_layout(const LoaderHello& hello) {
    if (hello.protocol_version == rover::loader::kProtocolVersion &&
        hello.application_first == kApplicationFirst && hello.application_end == kRecordPage &&
        hello.page_size == kPageSize) {
        return;
    }
    throw FlashError(fmt::format(
        "the loader speaks version {} and has its application at {:04X}H-{:04X}H in pages of {}; "
        "known are version {}, {:04X}H-{:04X}H, {}: use the rover85 of the loader's version",
        hello.protocol_version, hello.application_first, hello.application_end - 1, hello.page_size,
        rover::loader::kProtocolVersion, kApplicationFirst, kRecordPage - 1, kPageSize));
}

bool is_the_image(const LoaderHello& hello, const Pages& pages) {
    const ImageIdentity& identity = pages.identity();
    return hello.identity && hello.identity->image_crc == identity.image_crc &&
           hello.identity->image_size == identity.image_size &&
           hello.identity->source_hash == identity.source_hash;
}

/// From whatever is in the board to a bootable image. @errors  Reopen
void bring_in(LoaderClient& client, const Pages& pages, const FlashOptions& options,
              FlashResult& result) {
    const LoaderHello hello = client.hello();
    check_layout(hello);
    if (options.keep_other_vehicles) check_vehicle(hello, pages);
    if (!result.before) result.before = hello.identity;
    auto different = different_pages(client, pages, options.progress, "compare");
    if (different.empty() && is_the_image(hello, pages) && !options.write_all) {
        result.was_bootable_already = result.pages_written == 0;
        result.after = hello.identity;
        return;
    }
    if (options.write_all && result.pages_written == 0) {
        different.resize(pages.count());
        for (std::size_t i = 0; i < different.size(); ++i) different[i] = i;
    }
    open(client);
    for (std::size_t i = 0; i < different.size(); ++i) {
        tell(options.progress, "write", i, different.size());
        write_page(client, Pages::address(different[i]), pages.page(different[i]));
        ++result.pages_written;
    }
    tell(options.progress, "write", different.size(), different.size());
    close(client, pages);
    const LoaderHello after = client.hello();
    if (!is_the_image(after, pages)) throw Reopen{};
    result.after = after.identity;
}

/// The same, again when the board was reset in between.
void bring_in_at_last(LoaderClient& client, const Pages& pages, const FlashOptions& options,
                      FlashResult& result) {
    for (unsigned round = 1;; ++round) {
        try {
            return bring_in(client, pages, options, result);
        } catch (const Reopen&) {
            if (round == options.rounds) {
                throw FlashError(
                    "the board was reset again and again; check its supply, then run the same "
                    "command: it goes on where it stopped");
            }
        } catch (const LoaderError&) {
            if (round == options.rounds || !options.lost || !options.lost()) throw;
        }
        ++result.resumed;
    }
}

}  // namespace

std::string likely_cause(std::span<const uint8_t> expected, std::span<const uint8_t> found) {
    const auto all = [&](auto&& is) { return std::ranges::all_of(found, is); };
    if (all([](uint8_t byte) { return byte == kErasedByte; })) {
        return "nothing was written: the part is protected, or WE does not reach it";
    }
    uint8_t differences = 0;
    for (std::size_t i = 0; i < std::min(expected.size(), found.size()); ++i) {
        differences = static_cast<uint8_t>(differences | (expected[i] ^ found[i]));
    }
    if (differences != 0 && (differences & (differences - 1)) == 0) {
        return "always the same bit: a data line, or a worn cell";
    }
    return "several bits: a bad contact, a weak supply, or a worn part";
}

std::optional<VerifyReport> verify_over_link(LoaderClient& client, const Image& image,
                                             const Progress& progress) {
    const Pages pages(image);
    const auto different = different_pages(client, pages, progress, "verify");
    std::optional<VerifyReport> report;
    std::vector<uint8_t> expected, found;
    for (const std::size_t index : different) {
        const auto bytes = client.read(Pages::address(index), kPageSize);
        const auto page = pages.page(index);
        for (std::size_t i = 0; i < kPageSize; ++i) {
            if (bytes[i] == page[i]) continue;
            if (!report) {
                report.emplace();
                report->first = static_cast<uint16_t>(Pages::address(index) + i);
                report->expected = page[i];
                report->found = bytes[i];
            }
            ++report->count;
            expected.push_back(page[i]);
            found.push_back(bytes[i]);
        }
        if (report) ++report->pages;
    }
    if (report) report->likely_cause = likely_cause(expected, found);
    return report;
}

FlashResult flash_over_link(LoaderClient& client, const Image& image, const FlashOptions& options) {
    const Pages pages(image);
    FlashResult result;
    result.pages = pages.count();
    bring_in_at_last(client, pages, options, result);
    return result;
}

}  // namespace host_sim
