// identity_test.cpp - the identity block: where its fields are, what is refused and why.
#include "host_sim/image/identity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "host_sim/image/board_image.hpp"
#include "host_sim/image/checksum.hpp"
#include "tests/host_sim/image/identity_image.hpp"

namespace {

using host_sim::Image;
using host_sim::ImageError;
using host_sim::ImageIdentity;
using image_test::kBlock;
using image_test::kFirst;
using image_test::kLast;
using image_test::put_block;
using image_test::unstamped;

constexpr host_sim::ImageVersion kVersion{1, 2, 3};
constexpr uint32_t kHash = 0xA1B2C3D4;

Image stamped() {
    Image image = unstamped();
    host_sim::stamp_identity(image, kVersion, kHash);
    return image;
}

template <class Work>
std::string error_of(Work&& work) {
    try {
        work();
    } catch (const ImageError& error) {
        return error.what();
    }
    return "accepted";
}

std::string stamp_error(Image image) {
    return error_of([&] { host_sim::stamp_identity(image, kVersion, kHash); });
}

std::string read_error(const Image& image) {
    return error_of([&] { (void)host_sim::read_identity(image); });
}

TEST(StampIdentity, FieldsLieWhereThePageSays) {
    const Image image = stamped();
    const std::array<uint8_t, 12> expected = {1,    1,    2,    3,     // format, version
                                              0xD4, 0xC3, 0xB2, 0xA1,  // low byte first
                                              0x41, 0x0C,              // size
                                              0,    0};
    for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(image.bytes[kBlock + 8 + i], expected[i]) << i;
}

TEST(StampIdentity, TheCheckIsThatOfTheWholeProgramWithItsFieldTakenAsZero) {
    const Image image = stamped();
    std::vector<uint8_t> program(image.bytes.begin() + kFirst, image.bytes.begin() + kLast + 1);
    constexpr std::size_t kCheck = kBlock - kFirst + 18;
    const unsigned crc = program[kCheck] + 256u * program[kCheck + 1];
    program[kCheck] = program[kCheck + 1] = 0;
    EXPECT_EQ(crc, host_sim::crc16_ccitt_false(program));
}

TEST(StampIdentity, NothingElseIsTouched) {
    const Image before = unstamped();
    const Image after = stamped();
    EXPECT_EQ(before.present, after.present);
    for (std::size_t at = 0; at < host_sim::kAddressSpaceSize; ++at) {
        if (at >= kBlock + 9 && at < kBlock + 20) continue;
        ASSERT_EQ(before.bytes[at], after.bytes[at]) << at;
    }
}

TEST(StampIdentity, GapsCountAsErasedBytes) {
    Image with_gap = unstamped();
    with_gap.present.reset(0x0C35);
    with_gap.bytes[0x0C35] = host_sim::kErasedByte;
    Image filled = unstamped();
    filled.put(0x0C35, 0xFF);
    EXPECT_EQ(host_sim::stamp_identity(with_gap, kVersion, kHash).image_crc,
              host_sim::stamp_identity(filled, kVersion, kHash).image_crc);
}

TEST(StampIdentity, AgainGivesTheSame) {
    Image image = stamped();
    host_sim::stamp_identity(image, kVersion, kHash);
    EXPECT_TRUE(image.same_content(stamped()));
}

TEST(StampIdentity, Refuses) {
    Image none = unstamped();
    none.put(kBlock + 7, 1);
    EXPECT_EQ(
        stamp_error(none),
        "a.hex: holds no identity block (\"ROVER85\" and a zero byte); give a rover85 image; a "
        "program of your own declares `rover_identity`");
    Image twice = unstamped();
    put_block(twice, kLast + 1);
    EXPECT_EQ(
        stamp_error(twice),
        "a.hex: holds the identity block more than once, at 0C10H and 0C41H; link the program "
        "with one `rover_identity`");
    Image large = unstamped();
    large.put(0x8000, 0);
    EXPECT_EQ(
        stamp_error(large),
        "a.hex: address 8000H is outside of the EEPROM 0000H-7FFFH; link the program for this "
        "memory");
    Image format = unstamped();
    format.put(kBlock + 8, 2);
    EXPECT_NE(stamp_error(format).find("format 2, known is 1"), std::string::npos);
    Image elsewhere = unstamped();
    elsewhere.present.reset(kFirst);
    EXPECT_NE(stamp_error(elsewhere).find("nothing at address 0C00H"), std::string::npos);
    Image cut = unstamped();
    for (std::size_t at = kBlock + 20; at <= kLast; ++at) cut.present.reset(at);
    EXPECT_NE(stamp_error(cut).find("ends inside of the identity block"), std::string::npos);
}

TEST(StampIdentity, RefusesAVehicleThatIsNoText) {
    for (const std::vector<uint8_t>& name :
         {std::vector<uint8_t>{0}, {'a', 0x1F}, {'a', 0, 'b'}, {0x80}}) {
        Image image = unstamped();
        for (std::size_t i = 0; i < 8; ++i) {
            image.put(static_cast<uint16_t>(kBlock + 20 + i), i < name.size() ? name[i] : 0);
        }
        EXPECT_NE(stamp_error(image).find("vehicle name"), std::string::npos);
    }
}

TEST(StampIdentity, TheLargestImageEndsBeforeTheBootRecord) {
    Image image = unstamped();
    image.put(0x7FBF, 0x00);
    EXPECT_EQ(host_sim::stamp_identity(image, kVersion, kHash).image_size, 0x7FC0);
}

TEST(ReadIdentity, GivesBackWhatWasStamped) {
    const ImageIdentity identity = host_sim::read_identity(stamped());
    EXPECT_EQ(identity.address, kBlock);
    EXPECT_EQ(identity.version, kVersion);
    EXPECT_EQ(identity.source_hash, kHash);
    EXPECT_EQ(identity.image_size, 0x0C41);
    EXPECT_EQ(identity.vehicle, "Rocky3.2");
    EXPECT_EQ(host_sim::describe_sources(identity), "rover85 1.2.3 sources a1b2c3d4");
    EXPECT_EQ(host_sim::describe(identity).find("rover85 1.2.3 sources a1b2c3d4 vehicle Rocky3.2, "
                                                "65 bytes, CRC-16 "),
              0u);
}

TEST(ReadIdentity, AShortVehicleNameEndsAtItsZero) {
    Image image = unstamped();
    for (const int at : {25, 26, 27}) image.put(static_cast<uint16_t>(kBlock + at), 0);
    EXPECT_EQ(host_sim::stamp_identity(image, kVersion, kHash).vehicle, "Rocky");
}

TEST(ReadIdentity, RefusesAnyChangedBit) {
    const Image good = stamped();
    for (std::size_t at = kFirst; at <= kLast; ++at) {
        for (unsigned bit = 0; bit < 8; ++bit) {
            Image image = good;
            image.bytes[at] ^= static_cast<uint8_t>(1u << bit);
            ASSERT_NE(read_error(image), "accepted") << at << " bit " << bit;
        }
    }
}

TEST(ReadIdentity, SaysWhatIsWrong) {
    EXPECT_EQ(
        read_error(unstamped()),
        "a.hex: has never been stamped; build it with the project's own rule, which stamps it");
    Image changed = stamped();
    changed.put(kFirst + 3, 0x00);
    EXPECT_NE(read_error(changed).find("a.hex: has the CRC-16 "), std::string::npos);
    Image longer = stamped();
    longer.put(kLast + 1, 0x00);
    EXPECT_NE(read_error(longer).find("says it ends at 0C41H, but there is a byte at 0C41H"),
              std::string::npos);
    Image cut = stamped();
    cut.present.reset(kLast);
    EXPECT_NE(read_error(cut).find("says it ends at 0C41H, but does at 0C40H"), std::string::npos);
}

TEST(ReadIdentity, PaddingBehindTheProgramIsNoFault) {
    const Image image = stamped();
    const std::string padded = host_sim::write_bin(image, {0, 0x7FFF});
    EXPECT_EQ(host_sim::read_identity(host_sim::read_bin(padded, 0, "a.bin")),
              host_sim::read_identity(image));
}

// -- The whole part ------------------------------------------------------------------------------

/// A loader of a JMP and an RET, in its two parts.
Image loader() {
    Image start, program;
    for (const uint8_t byte : {uint8_t{0xC3}, uint8_t{0x00}, uint8_t{0x00}}) {
        start.put(static_cast<uint16_t>(start.byte_count()), byte);
    }
    program.put(0xE000, 0xC9);
    return host_sim::loader_image(start, program);
}

TEST(BoardImage, LoaderAndRecordLieWhereThePageSays) {
    Image image = stamped();
    const ImageIdentity identity = host_sim::read_identity(image);
    host_sim::complete_for_board(image, identity, loader());
    EXPECT_EQ(image.bytes[0x0000], 0xC3);
    EXPECT_EQ(image.bytes[0x0200], 0xC9);
    const std::vector<uint8_t> record(image.bytes.begin() + 0x7FC0, image.bytes.begin() + 0x7FCC);
    const auto low = [](unsigned word) { return static_cast<uint8_t>(word & 0xFF); };
    const unsigned crc = identity.image_crc;
    std::vector<uint8_t> expected = {'R',  '8',      '5',           'B',  0x41,
                                     0x0C, low(crc), low(crc >> 8), 0x10, 0x0C};
    const unsigned check = host_sim::crc16_ccitt_false(expected);
    expected.push_back(low(check));
    expected.push_back(low(check >> 8));
    EXPECT_EQ(record, expected);
    EXPECT_EQ(host_sim::read_identity(image), identity);
}

TEST(BoardImage, ARecordOfAnotherImageIsRefused) {
    Image image = stamped();
    host_sim::complete_for_board(image, host_sim::read_identity(image), loader());
    image.bytes[0x7FC4] ^= 1;
    EXPECT_NE(read_error(image).find("boot record at 7FC0H"), std::string::npos);
}

TEST(BoardImage, PartsOutsideOfTheirPlacesAreRefused) {
    Image start, program;
    start.put(0x0200, 0);
    program.put(0xE000, 0);
    EXPECT_NE(error_of([&] {
                  (void)host_sim::loader_image(start, program);
              }).find("0200H is outside of the loader's first part"),
              std::string::npos);
    start = Image();
    start.put(0, 0);
    program.put(0xEA00, 0);
    EXPECT_NE(error_of([&] {
                  (void)host_sim::loader_image(start, program);
              }).find("EA00H is outside of the loader's second part"),
              std::string::npos);
    Image image = stamped();
    const ImageIdentity identity = host_sim::read_identity(image);
    image.put(0x0BFF, 0);
    EXPECT_NE(error_of([&] {
                  host_sim::complete_for_board(image, identity, loader());
              }).find("0BFFH is outside of the application's part"),
              std::string::npos);
}

TEST(BoardImage, PagesForTheLinkAreWholeAndPadded) {
    const Image image = stamped();
    const auto pages = host_sim::application_pages(image, host_sim::read_identity(image));
    ASSERT_EQ(pages.size(), 128u);
    EXPECT_TRUE(std::equal(pages.begin(), pages.begin() + 65, image.bytes.begin() + kFirst));
    EXPECT_TRUE(std::all_of(pages.begin() + 65, pages.end(), [](uint8_t b) { return b == 0xFF; }));
}

TEST(ParseVersion, ThreeNumbersUpTo255) {
    EXPECT_EQ(host_sim::parse_version("0.1.0"), (host_sim::ImageVersion{0, 1, 0}));
    EXPECT_EQ(host_sim::parse_version("255.0.12"), (host_sim::ImageVersion{255, 0, 12}));
    for (const char* wrong :
         {"", "1", "1.2", "1.2.", "1.2.3.4", "1.2.256", "1.2.3 ", "-1.2.3", "a.b.c", "1,2,3"}) {
        EXPECT_FALSE(host_sim::parse_version(wrong)) << wrong;
    }
}

}  // namespace
