// board_image.cpp - see board_image.hpp.
#include "host_sim/image/board_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <vector>

#include "host_sim/image/checksum.hpp"

namespace host_sim {
namespace {

namespace layout = rover::loader;

/// Copies what an image has, moved by `offset`.
void put_all(Image& to, const Image& from, int offset) {
    for (std::size_t at = 0; at < kAddressSpaceSize; ++at) {
        if (!from.present[at]) continue;
        to.put(static_cast<uint16_t>(static_cast<int>(at) + offset), from.bytes[at]);
    }
}

}  // namespace

Image loader_image(const Image& start, const Image& program) {
    check_range(start, {0, layout::kStartLast}, "the loader's first part");
    check_range(program, {layout::kProgramFirst, layout::kProgramFirst + layout::kProgramSize - 1},
                "the loader's second part");
    Image loader;
    loader.file = program.file;
    put_all(loader, start, 0);
    put_all(loader, program, layout::kStoredProgramFirst - layout::kProgramFirst);
    return loader;
}

BootRecordBytes boot_record(const ImageIdentity& identity) {
    BootRecordBytes record{};
    std::ranges::copy(layout::kRecordMagic, record.begin());
    const auto put = [&](std::size_t at, uint16_t word) {
        record[at] = static_cast<uint8_t>(word);
        record[at + 1] = static_cast<uint8_t>(word >> 8);
    };
    put(4, identity.image_size);
    put(6, identity.image_crc);
    put(8, identity.address);
    put(layout::kBootRecordChecked,
        crc16_ccitt_false(std::span(record).first(layout::kBootRecordChecked)));
    return record;
}

void complete_for_board(Image& application, const ImageIdentity& identity, const Image& loader) {
    check_range(application, {layout::kApplicationFirst, layout::kApplicationLast},
                "the application's part");
    put_all(application, loader, 0);
    uint16_t at = layout::kRecordPage;
    for (const uint8_t byte : boot_record(identity)) application.put(at++, byte);
}

void check_boot_record(const Image& image, const ImageIdentity& identity) {
    const auto found = std::span(image.bytes).subspan(layout::kRecordPage, layout::kPageSize);
    if (std::ranges::all_of(found, [](uint8_t byte) { return byte == kErasedByte; })) return;
    const BootRecordBytes expected = boot_record(identity);
    if (std::ranges::equal(found.first(expected.size()), expected)) return;
    throw ImageError(image.file, 0,
                     fmt::format("has a boot record at {:04X}H that is not that of its application",
                                 layout::kRecordPage),
                     "it was put together by hand; build it anew");
}

std::vector<uint8_t> application_pages(const Image& image, const ImageIdentity& identity) {
    const std::size_t size =
        (byte_count(identity) + layout::kPageSize - 1) / layout::kPageSize * layout::kPageSize;
    std::vector<uint8_t> pages(size, kErasedByte);
    const auto first = image.bytes.begin() + layout::kApplicationFirst;
    std::copy_n(first, byte_count(identity), pages.begin());
    return pages;
}

}  // namespace host_sim
