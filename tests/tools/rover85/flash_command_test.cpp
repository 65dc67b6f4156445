// flash_command_test.cpp - what `rover85 flash` checks, writes and says. srec_cat (package srecord)
// is the independent reader of the Intel HEX.
#include "tools/rover85/flash_command.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "host_sim/image/board_image.hpp"
#include "host_sim/image/checksum.hpp"
#include "host_sim/image/identity.hpp"
#include "host_sim/link/serial_port.hpp"
#include "tests/host_sim/image/identity_image.hpp"
#include "tests/tools/rover85/command_line.hpp"
#include "tools/rover85/flash_link.hpp"

namespace {

using host_sim::Image;
using rover85_test::Outcome;
using rover85_test::TestFolder;

void write(const std::string& file, const std::string& content) {
    std::ofstream(file, std::ios::binary) << content;
}

std::string read(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// A folder with a.hex: a stamped image of 65 bytes, a loader of one instruction, a boot record.
class FlashCommand : public testing::Test {
protected:
    FlashCommand() {
        complete(image);
        write(hex, host_sim::write_hex(image));
    }
    static void complete(Image& application) {
        const auto identity = host_sim::stamp_identity(application, {0, 1, 0}, 0x1A2B3C4D);
        Image loader;
        loader.put(0, 0x76);
        host_sim::complete_for_board(application, identity, loader);
    }

    Outcome flash(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "flash");
        return rover85_test::run_command(add_flash_command, arguments);
    }
    Outcome flash_to_out() { return flash({hex, "--backend", "file", "--out", out}); }

    TestFolder folder{"flash_" +
                      std::string(testing::UnitTest::GetInstance()->current_test_info()->name())};
    Image image = image_test::unstamped();
    std::string hex = folder.file("a.hex");
    std::string out = folder.file("part.bin");
};

TEST_F(FlashCommand, WritesTheWholePartPaddedWithErasedBytes) {
    const Outcome outcome = flash_to_out();
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const std::string bin = read(out);
    ASSERT_EQ(bin.size(), 32768u);
    EXPECT_EQ(bin, host_sim::write_bin(image, {0, 0x7FFF}));
    EXPECT_EQ(bin[0], 0x76);
    EXPECT_EQ(bin.find_first_not_of('\xFF', 1), image_test::kFirst);
    EXPECT_EQ(bin.find_first_not_of('\xFF', image_test::kLast + 1u), 0x7FC0u);
}

TEST_F(FlashCommand, PrintsSizeChecksAndIdentity) {
    const Outcome outcome = flash_to_out();
    const std::string bin = read(out);
    const std::vector<uint8_t> bytes(bin.begin(), bin.end());
    char checks[100];
    std::snprintf(checks, sizeof checks, "CRC-16 %04XH, CRC-32 %08XH, sum of bytes %04XH",
                  host_sim::crc16_ccitt_false(bytes), host_sim::crc32(bytes),
                  host_sim::byte_sum(bytes));
    EXPECT_NE(outcome.out.find(checks), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("rover85 0.1.0 sources 1a2b3c4d vehicle Rocky3.2, 65 bytes"),
              std::string::npos);
    EXPECT_NE(outcome.out.find("65 of 29632 bytes (0.2 %)"), std::string::npos);
    EXPECT_NE(outcome.out.find("verified  " + out + ": all 32768 bytes"), std::string::npos);
    EXPECT_NE(outcome.out.find("minipro -p AT28C256 -u -w " + out), std::string::npos);
}

TEST_F(FlashCommand, SrecCatReadsTheHexAsTheSameProgram) {
    ASSERT_EQ(flash_to_out().exit_code, 0);
    const std::string program = folder.file("srec.bin");
    const std::string command = "srec_cat " + folder.file("part.hex") +
                                " -intel -fill 0xFF 0x0000 0x8000 -o " + program + " -binary";
    ASSERT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(read(program), read(out));
}

TEST_F(FlashCommand, TakesABinAndOnePaddedAlready) {
    ASSERT_EQ(flash_to_out().exit_code, 0);
    const std::string first = read(out);
    const std::string bin = folder.file("b.bin");
    write(bin, host_sim::write_bin(image, {0, 0x7FCB}));
    ASSERT_EQ(flash({bin, "--backend", "file", "--out", folder.file("c.bin")}).exit_code, 0);
    EXPECT_EQ(read(folder.file("c.bin")), first);
    ASSERT_EQ(
        flash({out, "--backend", "file", "--size", "64K", "--out", folder.file("d.bin")}).exit_code,
        0);
    EXPECT_EQ(read(folder.file("d.bin")), first + std::string(32768, '\xFF'));
    EXPECT_EQ(read(folder.file("d.hex")), read(folder.file("part.hex")));
}

TEST_F(FlashCommand, ADryRunWritesNothing) {
    const Outcome outcome = flash({hex, "--backend", "file", "--out", out, "--dry-run"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_NE(outcome.out.find("were not written"), std::string::npos);
    EXPECT_NE(outcome.out.find("CRC-32"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(out));
    EXPECT_FALSE(std::filesystem::exists(folder.file("part.hex")));
}

TEST_F(FlashCommand, WhatWasReadFromAPartIsCompared) {
    ASSERT_EQ(flash_to_out().exit_code, 0);
    std::string bin = read(out);
    const std::string part = folder.file("read.bin");
    write(part, bin);
    EXPECT_EQ(flash({hex, "--backend", "file", "--compare", part}).exit_code, 0);
    bin[0x0C05] = 0x00;  // HLT, 76H
    bin[0x7000] = 0x12;
    write(part, bin);
    const Outcome outcome = flash({hex, "--backend", "file", "--compare", part});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_NE(outcome.out.find("first wrong address 0C05H: 00H instead of 76H"), std::string::npos)
        << outcome.out;
    EXPECT_NE(outcome.out.find("; 2 of 32768 bytes are wrong; likely cause: several bits"),
              std::string::npos)
        << outcome.out;
    write(part, bin.substr(0, 100));
    EXPECT_NE(flash({hex, "--backend", "file", "--compare", part}).out.find("of 32768 bytes"),
              std::string::npos);
}

TEST_F(FlashCommand, RefusesAnApplicationAloneForAProgrammer) {
    Image alone = image_test::unstamped();
    host_sim::stamp_identity(alone, {0, 1, 0}, 0x1A2B3C4D);
    write(hex, host_sim::write_hex(alone));
    const Outcome outcome = flash_to_out();
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_NE(outcome.err.find("has no loader or no boot record"), std::string::npos)
        << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(FlashCommand, RefusesDamagedAndUnstampedImages) {
    const auto refusal = [&](const std::string& content) {
        write(hex, content);
        const Outcome outcome = flash_to_out();
        EXPECT_EQ(outcome.exit_code, 3);
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
        EXPECT_FALSE(std::filesystem::exists(out));
        return outcome.err;
    };
    EXPECT_NE(refusal(host_sim::write_hex(image_test::unstamped())).find("never been stamped"),
              std::string::npos);
    image.put(0x0C05, 0x00);
    EXPECT_NE(refusal(host_sim::write_hex(image)).find("CRC-16"), std::string::npos);
    EXPECT_NE(refusal(":00000001FE\n").find("a.hex:1:"), std::string::npos);
    EXPECT_NE(refusal("").find("a.hex: the file is empty"), std::string::npos);
}

TEST_F(FlashCommand, AFileThatCannotBeWrittenIsNamed) {
    const Outcome outcome =
        flash({hex, "--backend", "file", "--out", folder.file("no/such/part.bin")});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_NE(outcome.err.find("part.bin: cannot be written"), std::string::npos);
}

// What is written there is not there when it is read.
TEST_F(FlashCommand, AFileThatDoesNotReadBackIsADifference) {
    std::filesystem::create_symlink("/dev/null", out);
    const Outcome outcome = flash_to_out();
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_NE(outcome.out.find("part.bin: first wrong address 0000H: nothing instead of 76H; 32768 "
                               "of 32768 bytes are wrong"),
              std::string::npos)
        << outcome.out;
    EXPECT_NE(outcome.out.find("verified  " + folder.file("part.hex")), std::string::npos);
}

TEST_F(FlashCommand, APortThatIsNotThereIsNamed) {
    const Outcome outcome = flash({hex, "--backend", "serial", "--port", "/dev/no_such_port"});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_NE(outcome.err.find("/dev/no_such_port: cannot be opened"), std::string::npos)
        << outcome.err;
}

TEST_F(FlashCommand, TheOnlySerialPortIsTaken) {
    const std::string devices = folder.file("dev");
    std::filesystem::create_directory(devices);
    EXPECT_THROW((void)only_serial_port(devices), host_sim::SerialError);
    write(devices + "/ttyS0", "");
    EXPECT_THROW((void)only_serial_port(devices), host_sim::SerialError);
    write(devices + "/ttyUSB1", "");
    EXPECT_EQ(only_serial_port(devices), devices + "/ttyUSB1");
    write(devices + "/ttyACM0", "");
    try {
        (void)only_serial_port(devices);
        ADD_FAILURE();
    } catch (const host_sim::SerialError& error) {
        EXPECT_NE(std::string(error.what()).find("ttyACM0, " + devices + "/ttyUSB1"),
                  std::string::npos)
            << error.what();
    }
}

TEST_F(FlashCommand, AnEepromFileOfAnotherSizeIsRefused) {
    write(out, "abc");
    const Outcome outcome = flash({hex, "--backend", "board", "--eeprom", out});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_NE(outcome.err.find("has 3 bytes, an EEPROM 32768"), std::string::npos) << outcome.err;
    EXPECT_EQ(read(out), "abc");
}

TEST_F(FlashCommand, UsageErrors) {
    EXPECT_EQ(flash({hex}).exit_code, 2);
    EXPECT_EQ(flash({hex, "--backend", "smoke"}).exit_code, 2);
    EXPECT_EQ(flash({hex, "--backend", "board"}).exit_code, 2);
    EXPECT_EQ(flash({hex, "--backend", "file", "--size", "8"}).exit_code, 2);
    EXPECT_EQ(flash({hex, "--backend", "serial", "--verify", "--dry-run"}).exit_code, 2);
    EXPECT_EQ(flash({hex, "--backend", "file", "--size", "33"}).exit_code, 2);
    EXPECT_EQ(flash({hex, "--backend", "file", "--out", "part.hex"}).exit_code, 2);
    EXPECT_EQ(flash({hex, "--backend", "file", "--compare", out, "--dry-run"}).exit_code, 2);
}

}  // namespace
