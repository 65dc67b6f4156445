// image_test.cpp - Intel HEX and BIN: what is read, what is refused and how, what is written.
// Records are by hand from the format's specification; checksums are two's complements of the sum.
// srec_cat (package srecord) is the independent reader and writer.
#include "host_sim/image/image.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

namespace {

namespace fs = std::filesystem;
using host_sim::AddressRange;
using host_sim::Image;
using host_sim::ImageError;
using host_sim::read_bin;
using host_sim::read_hex;

constexpr const char* kEnd = ":00000001FF\n";

std::string hex_error(const std::string& text) {
    try {
        (void)read_hex(text, "a.hex");
    } catch (const ImageError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(ReadHex, BytesComeToTheirAddresses) {
    // 03+01+00+C3+34+12 = 10DH: checksum F3. 01+7F+FF+76 = 1F5H: checksum 0B.
    const Image image = read_hex(std::string(":03010000C33412F3\n:017FFF00760B\n") + kEnd, "a.hex");
    EXPECT_EQ(image.byte_count(), 4u);
    EXPECT_EQ(image.bytes[0x0100], 0xC3);
    EXPECT_EQ(image.bytes[0x0101], 0x34);
    EXPECT_EQ(image.bytes[0x0102], 0x12);
    EXPECT_EQ(image.bytes[0x7FFF], 0x76);
    EXPECT_EQ(image.bytes[0x0103], host_sim::kErasedByte);
    EXPECT_FALSE(image.start.has_value());
    EXPECT_EQ(image.segments(), (std::vector<AddressRange>{{0x0100, 0x0102}, {0x7FFF, 0x7FFF}}));
    EXPECT_EQ(image.extent(), (AddressRange{0x0100, 0x7FFF}));
}

TEST(ReadHex, CarriageReturnsLowerCaseEmptyLinesAndNoLastLineFeedAreFine) {
    const Image image = read_hex(":03010000c33412f3\r\n\r\n:00000001ff", "a.hex");
    EXPECT_EQ(image.byte_count(), 3u);
    EXPECT_EQ(image.bytes[0x0100], 0xC3);
}

TEST(ReadHex, TheLastByteOfMemoryCanBeGiven) {
    // 01+FF+FF+55 = 254H: checksum AC.
    EXPECT_EQ(read_hex(std::string(":01FFFF0055AC\n") + kEnd, "a.hex").bytes[0xFFFF], 0x55);
}

TEST(ReadHex, StartAddressesOfAllThreeForms) {
    const std::string data = ":03010000C33412F3\n";
    // 04+05+01+00 = 0AH: F6. 04+03+01+00 = 08H: F8. 01+00+01 = 02H: FE.
    EXPECT_EQ(read_hex(data + ":0400000500000100F6\n" + kEnd, "a").start, 0x0100);
    EXPECT_EQ(read_hex(data + ":0400000300000100F8\n" + kEnd, "a").start, 0x0100);
    EXPECT_EQ(read_hex(data + ":00010001FE\n", "a").start, 0x0100);
    EXPECT_EQ(hex_error(data + ":0400000500000100F6\n:00010101FD\n"),
              "a.hex:3: starts at 0101H, but line 2 at 0100H; keep one of them");
}

TEST(ReadHex, ABaseOfZeroChangesNothing) {
    // 02+04 = 06H: FA; 02+02 = 04H: FC.
    const Image image =
        read_hex(std::string(":020000040000FA\n:020000020000FC\n:03010000C33412F3\n") + kEnd, "a");
    EXPECT_EQ(image.bytes[0x0100], 0xC3);
    EXPECT_EQ(image.byte_count(), 3u);
}

TEST(ReadHex, DamageIsRefusedWithLineAndAdvice) {
    const std::string damaged = "; the file is damaged: make or copy it again";
    EXPECT_EQ(hex_error(std::string("\n:03010000C33412F2\n") + kEnd),
              "a.hex:2: checksum is F2, but the bytes give F3" + damaged);
    EXPECT_EQ(hex_error(std::string(":03010000C33412F\n") + kEnd),
              "a.hex:1: has an odd number of digits, 15" + damaged);
    EXPECT_EQ(hex_error(std::string(":03010000C3G412F3\n") + kEnd),
              "a.hex:1: column 12 is no hexadecimal digit" + damaged);
    EXPECT_EQ(hex_error(std::string(":03010000C334F3\n") + kEnd),
              "a.hex:1: says 3 data bytes, but has 2" + damaged);
    EXPECT_EQ(hex_error(std::string(":03010000C3341200F3\n") + kEnd),
              "a.hex:1: says 3 data bytes, but has 4" + damaged);
    EXPECT_EQ(hex_error(std::string(":030100\n") + kEnd),
              "a.hex:1: is too short to be a record" + damaged);
    EXPECT_EQ(hex_error(":03010000C33412F3\n"),
              "a.hex:1: the file ends without an end record (type 01)" + damaged);
    EXPECT_EQ(hex_error(""), "a.hex: the file ends without an end record (type 01)" + damaged);
    EXPECT_EQ(hex_error(":03010000C33412F3\n:0100000100FE\n"),
              "a.hex:2: record type 01 has 1 data bytes instead of 0" + damaged);
    EXPECT_EQ(hex_error(std::string(":0100000400FB\n") + kEnd),
              "a.hex:1: record type 04 has 1 data bytes instead of 2" + damaged);
}

TEST(ReadHex, WhatIsNoImageForThisMachineIsRefused) {
    const std::string link = "; link the program for the 64 KB of the 8085";
    EXPECT_EQ(hex_error(std::string("03010000C33412F3\n") + kEnd),
              "a.hex:1: does not start with ':'; give an Intel HEX file");
    EXPECT_EQ(hex_error(std::string(":00000006FA\n") + kEnd),
              "a.hex:1: record type 06 is unknown; give an Intel HEX file");
    EXPECT_EQ(hex_error(std::string(":020000040001F9\n") + kEnd),
              "a.hex:1: sets a base above the first 64 KB" + link);
    EXPECT_EQ(hex_error(std::string(":020000021000EC\n") + kEnd),
              "a.hex:1: sets a base above the first 64 KB" + link);
    EXPECT_EQ(hex_error(std::string(":0400000500010000F6\n") + kEnd),
              "a.hex:1: starts the program above FFFFH" + link);
    // 02+FF+FF = 200H: checksum 00.
    EXPECT_EQ(hex_error(std::string(":02FFFF00000000\n") + kEnd),
              "a.hex:1: 2 bytes from FFFFH on go beyond FFFFH" + link);
    EXPECT_EQ(hex_error(kEnd), "a.hex: the image has no bytes; check how it was made");
    EXPECT_EQ(hex_error(std::string(":03010000C33412F3\n") + kEnd + ":03010000C33412F3\n"),
              "a.hex:3: comes after the end record of line 2; give one image per file");
}

TEST(ReadHex, AnAddressGivenTwiceIsRefusedEvenWithTheSameByte) {
    EXPECT_EQ(hex_error(std::string(":03010000C33412F3\n:0101020012EA\n") + kEnd),
              "a.hex:2: address 0102H is given again, first at line 1; link the program so that "
              "nothing overlaps");
}

RC_GTEST_PROP(ReadHex, NoSingleChangedCharacterGoesUnnoticed, ()) {
    const std::string good = ":0B0010006164647265737320676170A7\n:00000001FF\n";
    const Image image = read_hex(good, "a");
    std::string bad = good;
    const auto at = *rc::gen::inRange<std::size_t>(0, bad.size());
    bad[at] = *rc::gen::inRange<char>(' ', '~');
    bool refused = false;
    Image other;
    try {
        other = read_hex(bad, "a");
    } catch (const ImageError&) {
        refused = true;
    }
    // A line feed that became a digit changes a length; only a changed case of a letter is the
    // same.
    RC_ASSERT(refused || other.same_content(image));
}

RC_GTEST_PROP(ReadHex, ArbitraryTextIsReadOrRefusedAndNothingElse, (const std::string& text)) {
    try {
        (void)read_hex(text, "a");
    } catch (const ImageError&) {
        RC_SUCCEED("refused");
    }
}

TEST(ReadBin, BytesStartAtTheLoadAddress) {
    const Image image = read_bin(std::string("\x00\xC9\xFF", 3), 0x0100, "a.bin");
    EXPECT_EQ(image.segments(), (std::vector<AddressRange>{{0x0100, 0x0102}}));
    EXPECT_EQ(image.bytes[0x0100], 0x00);
    EXPECT_EQ(image.bytes[0x0101], 0xC9);
    EXPECT_EQ(read_bin(std::string(0x10000, 'x'), 0, "a.bin").byte_count(), 0x10000u);
}

TEST(ReadBin, EmptyAndTooLongAreRefused) {
    const auto error = [](const std::string& content, uint16_t load) -> std::string {
        try {
            (void)read_bin(content, load, "a.bin");
        } catch (const ImageError& e) {
            return e.what();
        }
        return "accepted";
    };
    EXPECT_EQ(error("", 0), "a.bin: the file is empty; give a program image");
    EXPECT_EQ(error("ab", 0xFFFF),
              "a.bin: has 2 bytes, but from FFFFH on there are only 1; give a lower load address "
              "or a smaller image");
    EXPECT_EQ(error("a", 0xFFFF), "accepted");
}

TEST(CheckRange, NamesTheFirstByteOutsideWithItsLine) {
    const Image image =
        read_hex(std::string(":03010000C33412F3\n:027FFF007612F8\n") + kEnd, "a.hex");
    EXPECT_NO_THROW(host_sim::check_range(image, {0x0100, 0x8000}, "ROM"));
    const auto error = [](const Image& i, AddressRange range) -> std::string {
        try {
            host_sim::check_range(i, range, "ROM");
        } catch (const ImageError& e) {
            return e.what();
        }
        return "accepted";
    };
    EXPECT_EQ(error(image, {0x0000, 0x7FFF}),
              "a.hex:2: address 8000H is outside of ROM 0000H-7FFFH; link the program for this "
              "memory");
    EXPECT_EQ(error(image, {0x0101, 0xFFFF}),
              "a.hex:1: address 0100H is outside of ROM 0101H-FFFFH; link the program for this "
              "memory");
    EXPECT_EQ(error(read_bin("a", 0x9000, "a.bin"), {0x0000, 0x7FFF}),
              "a.bin: address 9000H is outside of ROM 0000H-7FFFH; link the program for this "
              "memory");
}

TEST(WriteHex, RecordsOfSixteenBytesAStartAndAnEnd) {
    Image image;
    for (unsigned i = 0; i < 17; ++i) image.put(static_cast<uint16_t>(0x0100 + i), 0x01);
    image.put(0xFFFF, 0x55);
    image.start = 0x0100;
    // 10+01+10*01 = 21H: DF. 01+01+10+01 = 13H: ED.
    EXPECT_EQ(host_sim::write_hex(image),
              ":1001000001010101010101010101010101010101DF\n:0101100001ED\n:01FFFF0055AC\n"
              ":0400000500000100F6\n:00000001FF\n");
}

TEST(WriteBin, GapsAreFilled) {
    Image image;
    image.put(0x10, 0xAA);
    image.put(0x12, 0xBB);
    EXPECT_EQ(host_sim::write_bin(image, {0x0F, 0x12}), "\xFF\xAA\xFF\xBB");
    EXPECT_EQ(host_sim::write_bin(image, {0x11, 0x12}, 0x76), "\x76\xBB");
    EXPECT_EQ(host_sim::write_bin(image, {0, 0xFFFF}).size(), 0x10000u);
}

Image arbitrary_image() {
    Image image;
    const auto blocks = *rc::gen::inRange(1, 6);
    for (int i = 0; i < blocks; ++i) {
        auto at = *rc::gen::arbitrary<uint16_t>();
        for (const uint8_t byte : *rc::gen::nonEmpty<std::vector<uint8_t>>()) {
            image.put(at, byte);
            if (++at == 0) break;
        }
    }
    if (*rc::gen::arbitrary<bool>()) image.start = *rc::gen::arbitrary<uint16_t>();
    return image;
}

RC_GTEST_PROP(WriteHex, ReadsBack, ()) {
    const Image image = arbitrary_image();
    RC_ASSERT(read_hex(host_sim::write_hex(image), "a").same_content(image));
}

class SrecCat : public testing::Test {
protected:
    void SetUp() override {
        if (std::system("srec_cat --version >/dev/null 2>&1") != 0) {
            FAIL() << "srec_cat is not installed (apt-get install srecord)";
        }
        std::string pattern = (fs::temp_directory_path() / "rover85-image-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
        for (unsigned i = 0; i < 1000; ++i) {
            image_.put(static_cast<uint16_t>(0x7F00 + i), static_cast<uint8_t>(i * 167 + i / 256));
        }
        image_.put(3, 0x42);
        image_.start = 0x7F00;
    }
    ~SrecCat() override {
        if (!folder_.empty()) fs::remove_all(folder_);
    }
    void run(const std::string& arguments) const {
        const std::string command =
            "cd '" + folder_.string() + "' && srec_cat " + arguments + " 2>&1";
        ASSERT_EQ(std::system(command.c_str()), 0) << command;
    }

    fs::path folder_;
    Image image_;
};

TEST_F(SrecCat, ItsHexIsRead) {
    std::ofstream(folder_ / "in.bin", std::ios::binary)
        << host_sim::write_bin(image_, {0x7F00, 0x7F00 + 999});
    run("in.bin -binary -offset 0x7F00 -generate 3 4 --constant 0x42 "
        "-execution-start-address 0x7F00 -o out.hex -intel");
    Image read = host_sim::load_hex(folder_ / "out.hex");
    EXPECT_TRUE(read.same_content(image_));
}

TEST_F(SrecCat, ReadsOurHex) {
    std::ofstream(folder_ / "in.hex", std::ios::binary) << host_sim::write_hex(image_);
    run("in.hex -intel -crop 0x7F00 0x82E8 -offset -0x7F00 -o out.bin -binary");
    Image read = host_sim::load_bin(folder_ / "out.bin", 0x7F00);
    EXPECT_EQ(host_sim::write_bin(read, {0x7F00, 0x82E7}),
              host_sim::write_bin(image_, {0x7F00, 0x82E7}));
    EXPECT_EQ(read.byte_count(), 1000u);
}

TEST(LoadImage, FilesThatCannotBeReadAreNamed) {
    const auto error = [](const fs::path& path) -> std::string {
        try {
            (void)host_sim::load_hex(path);
        } catch (const ImageError& e) {
            return e.what();
        }
        return "accepted";
    };
    EXPECT_EQ(error("no-such-file.hex"),
              "no-such-file.hex: cannot be opened: No such file or directory; check the path and "
              "its permissions");
    const fs::path folder = fs::temp_directory_path();
    EXPECT_EQ(error(folder), folder.string() +
                                 ": cannot be read: Is a directory; check the path and its "
                                 "permissions");
}

}  // namespace
