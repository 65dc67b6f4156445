// misuse_test.cpp - requests that must not work, images that must not fly, noise: the loader's own
// region stays as it is, and the loader answers.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <thread>
#include <vector>

#include "firmware/config/eeprom_layout.hpp"
#include "tests/system/loader/loader_bench.hpp"

namespace {

using host_sim::Image;
using host_sim::LoaderClient;
using loader_test::built_image;
using loader_test::LoaderBench;
using loader_test::other_image;
using rover::loader::Result;
using std::chrono::milliseconds;
using Page = std::array<uint8_t, 64>;

constexpr milliseconds kSoon{20'000};

class Misuse : public testing::Test {
protected:
    Misuse() {
        bench.live.start();
        client.reach(kSoon);
    }
    LoaderBench bench;
    LoaderClient client{bench.client()};
};

TEST_F(Misuse, OnlyPagesOfTheApplicationCanBeWritten) {
    const Page page{};
    ASSERT_EQ(client.open().result, Result::done);
    for (const unsigned address : {0x0000U, 0x0BC0U, 0x0BFFU, 0x0C01U, 0x0C20U, 0x7FC0U, 0x7FFFU,
                                   0x8000U, 0xE000U, 0xFFC0U}) {
        const auto report = client.write(static_cast<uint16_t>(address), page);
        EXPECT_EQ(report.result, Result::wrong_address) << address;
        EXPECT_EQ(report.address, address);
    }
    EXPECT_EQ(client.write(0x0C00, page).result, Result::done);
    EXPECT_EQ(client.write(0x7F80, page).result, Result::done);
    bench.live.stop();
    EXPECT_TRUE(bench.loader_is_untouched());
    EXPECT_EQ(bench.live.board().state.eeprom.cycle_count, 2u) << "the record page was erased";
}

TEST_F(Misuse, NothingIsWrittenBeforeOpen) {
    EXPECT_EQ(client.write(0x0C00, Page{}).result, Result::not_open);
    EXPECT_EQ(client.close(0x1000).result, Result::not_open);
    bench.live.stop();
    EXPECT_EQ(bench.live.board().state.eeprom.cycle_count, 0u);
}

TEST_F(Misuse, WrongSizesAndTypesAreSaid) {
    auto line = bench.line();
    host_sim::DownlinkReader reader;
    const auto ask = [&](uint8_t type, std::vector<uint8_t> payload) -> int {
        line.write(host_sim::uplink_frame(type, payload));
        std::array<uint8_t, 1> byte{};
        while (line.read(byte, milliseconds(2000)) != 0) {
            if (const auto frame = reader.take(byte[0], 0)) {
                EXPECT_EQ(frame->kind(), type | 0x80);
                return frame->payload()[0];
            }
        }
        return -1;
    };
    constexpr int kWrongSize = 2, kUnknown = 1, kWrongAddress = 3, kNotBootable = 10;
    EXPECT_EQ(ask(0x11, {0}), kWrongSize);
    EXPECT_EQ(ask(0x12, std::vector<uint8_t>(65)), kWrongSize);
    EXPECT_EQ(ask(0x13, {0, 0}), kWrongSize);
    EXPECT_EQ(ask(0x15, {}), kWrongSize);
    EXPECT_EQ(ask(0x0F, {}), kUnknown);
    EXPECT_EQ(ask(0x17, {}), kUnknown);
    EXPECT_EQ(ask(0x01, {}), kUnknown);
    EXPECT_EQ(ask(0x13, {0, 0, 0}), kWrongAddress);
    EXPECT_EQ(ask(0x13, {0, 0, 33}), kWrongAddress);
    EXPECT_EQ(ask(0x14, {0, 0, 65}), kWrongAddress);
    EXPECT_EQ(ask(0x14, {0, 0x80, 1}), kWrongAddress);
    EXPECT_EQ(ask(0x16, {}), kNotBootable);
}

/// Writes what an image has, and asks the loader to make it bootable.
Result bring_in(LoaderClient& client, const Image& image, uint16_t identity_at) {
    EXPECT_EQ(client.open().result, Result::done);
    for (unsigned at = 0x0C00; at < 0x7FC0; at += 64) {
        Page page;
        std::copy_n(image.bytes.begin() + at, 64, page.begin());
        if (std::ranges::all_of(page, [](uint8_t byte) { return byte == 0xFF; })) continue;
        EXPECT_EQ(client.write(static_cast<uint16_t>(at), page).result, Result::done);
    }
    return client.close(identity_at).result;
}

TEST_F(Misuse, DamagedAndForeignImagesAreNotMadeBootable) {
    const auto identity = host_sim::read_identity(built_image());
    Image damaged = built_image();
    damaged.bytes[0x1234] = static_cast<uint8_t>(damaged.bytes[0x1234] ^ 0x10);
    EXPECT_EQ(bring_in(client, damaged, identity.address), Result::wrong_crc);
    EXPECT_FALSE(client.hello().bootable);
    EXPECT_EQ(client.close(static_cast<uint16_t>(identity.address + 1)).result,
              Result::no_identity);
    EXPECT_EQ(client.close(0x0000).result, Result::no_identity);
    EXPECT_EQ(client.close(0x7FFF).result, Result::no_identity);
    Image sized = built_image();
    sized.bytes[identity.address + 16u] = 0xC1;  // 7FC1H: a byte of the record page
    sized.bytes[identity.address + 17u] = 0x7F;
    EXPECT_EQ(bring_in(client, sized, identity.address), Result::wrong_image_size);
    sized.bytes[identity.address + 16u] = static_cast<uint8_t>(identity.address + 27);
    sized.bytes[identity.address + 17u] = static_cast<uint8_t>((identity.address + 27) >> 8);
    EXPECT_EQ(bring_in(client, sized, identity.address), Result::wrong_image_size);
    EXPECT_EQ(client.start().result, Result::not_bootable);
    EXPECT_FALSE(client.hello().bootable);
    EXPECT_EQ(bring_in(client, built_image(), identity.address), Result::done);
    EXPECT_TRUE(client.hello().bootable);
}

/// A program that is as good an image as any, for whoever does not run it.
Image program(const std::vector<uint8_t>& code) {
    Image image;
    image.file = "program";
    uint16_t at = rover::loader::kApplicationFirst;
    for (const uint8_t byte : code) image.put(at++, byte);
    constexpr std::string_view kBlock{"ROVER85\0\1\0\0\0\0\0\0\0\0\0\0\0Rocky3.2", 28};
    for (const char byte : kBlock) image.put(at++, static_cast<uint8_t>(byte));
    const auto identity = host_sim::stamp_identity(image, {0, 0, 1}, 1);
    Image none;
    host_sim::complete_for_board(image, identity, none);
    return image;
}

// Bad images that pass every check: they halt; loop without an edge for the watchdog; loop with
// one, deaf; and random code.
TEST(BadImages, TheLoaderIsReachedBehindAReset) {
    std::vector<std::vector<uint8_t>> programs = {
        {0x76},                                                  // HLT
        {0xC3, 0x00, 0x0C},                                      // JMP 0C00H
        {0x3E, 0xC0, 0x30, 0x3E, 0x40, 0x30, 0xC3, 0x00, 0x0C},  // SOD up and down for ever
    };
    std::mt19937 random(20260);
    for (int i = 0; i < 5; ++i) {
        std::vector<uint8_t> code(300);
        for (uint8_t& byte : code) byte = static_cast<uint8_t>(random());
        programs.push_back(code);
    }
    for (std::size_t i = 0; i < programs.size(); ++i) {
        LoaderBench bench;
        bench.live.start();
        auto client = bench.client();
        client.reach(kSoon);
        host_sim::flash_over_link(client, program(programs[i]), {});
        ASSERT_EQ(client.start().result, Result::done) << i;
        // It has run for a while when somebody presses RESET.
        bench.live.at(bench.live.elapsed_t() + 2 * loader_test::kSecondT,
                      [](host_sim::Board& board) { board.reset(); });
        std::this_thread::sleep_for(milliseconds(1500));
        client.reach(kSoon);
        const Image good = program({0x00, 0x76});
        host_sim::flash_over_link(client, good, {.lost = [&client] {
                                      client.reach(kSoon);  // RESET came in mid-transfer
                                      return true;
                                  }});
        bench.live.stop();
        EXPECT_TRUE(bench.holds(good)) << i;
        EXPECT_TRUE(bench.loader_is_untouched()) << i;
    }
}

TEST_F(Misuse, NoiseIsNoRequest) {
    std::mt19937 random(5);
    auto line = bench.line();
    std::vector<uint8_t> noise(2000);
    for (uint8_t& byte : noise) byte = static_cast<uint8_t>(random());
    for (std::size_t i = 0; i + 4 < noise.size(); i += 97) {  // and beginnings of frames
        noise[i] = 0xC5;
        noise[i + 1] = 0x3A;
        noise[i + 2] = 0x12;
        noise[i + 3] = static_cast<uint8_t>(i % 80);
    }
    line.write(noise);
    const auto hello = client.reach(kSoon);
    EXPECT_FALSE(hello.is_open);
    bench.live.stop();
    EXPECT_EQ(bench.live.board().state.eeprom.cycle_count, 0u);
    EXPECT_EQ(bench.powered, 0u);
}

}  // namespace
