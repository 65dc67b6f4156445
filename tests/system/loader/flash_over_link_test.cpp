// flash_over_link_test.cpp - an image goes into a board over its serial line: what ends up in the
// EEPROM, what is refused, what the host is told.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/system/loader/loader_bench.hpp"

namespace {

using host_sim::FlashResult;
using loader_test::built_image;
using loader_test::LoaderBench;
using loader_test::other_image;
using std::chrono::milliseconds;

constexpr milliseconds kSoon{20'000};

/// Pages that an erased part does not hold already.
std::size_t pages_with_content(const host_sim::Image& image) {
    const auto bytes = application_pages(image, read_identity(image));
    std::size_t count = 0;
    for (std::size_t at = 0; at < bytes.size(); at += 64) {
        const auto page = std::span(bytes).subspan(at, 64);
        if (std::ranges::any_of(page, [](uint8_t byte) { return byte != 0xFF; })) ++count;
    }
    return count;
}

TEST(FlashOverLink, FromTheLoaderAloneToAFlyingImage) {
    LoaderBench bench;
    bench.live.start();
    auto client = bench.client();
    const auto hello = client.reach(kSoon);
    EXPECT_FALSE(hello.bootable);
    const FlashResult result = flash_over_link(client, built_image(), {});
    EXPECT_FALSE(result.before);
    ASSERT_TRUE(result.after);
    EXPECT_EQ(result.pages_written, pages_with_content(built_image()));
    EXPECT_EQ(client.repeated(), 0u);
    EXPECT_EQ(client.start().result, rover::loader::Result::done);
    EXPECT_TRUE(bench.flies(built_image()));
    bench.live.stop();
    EXPECT_TRUE(bench.holds(built_image()));
    EXPECT_TRUE(bench.loader_is_untouched());
    EXPECT_GT(bench.samples, 1000u);
    EXPECT_EQ(bench.powered, 0u);
    std::printf("%zu pages in %.1f s of the board's time\n", result.pages,
                static_cast<double>(bench.live.elapsed_t()) / loader_test::kSecondT);
}

TEST(FlashOverLink, AFlyingImageIsTakenIntoTheLoaderAndReplaced) {
    LoaderBench bench(true);
    bench.live.start();
    ASSERT_TRUE(bench.flies(built_image()));
    auto client = bench.client();
    const auto hello = client.reach(kSoon);
    EXPECT_TRUE(hello.bootable);
    EXPECT_EQ(hello.entry, rover::loader::Entry::asked);
    ASSERT_TRUE(hello.identity);
    EXPECT_EQ(hello.identity->vehicle, "Rocky3.2");
    const auto other = other_image();
    const FlashResult result = flash_over_link(client, other, {.keep_other_vehicles = false});
    EXPECT_EQ(result.pages_written, 1u) << "the identity and nothing else differs";
    EXPECT_EQ(client.start().result, rover::loader::Result::done);
    EXPECT_TRUE(bench.flies(other));
    bench.live.stop();
    EXPECT_TRUE(bench.holds(other));
    EXPECT_EQ(bench.powered, 0u);
}

TEST(FlashOverLink, AWrongByteIsFoundAndMended) {
    LoaderBench bench(true);
    bench.live.board().program(std::array<uint8_t, 1>{0x00}, 0x2345);
    const bool was_zero = built_image().bytes[0x2345] == 0;
    bench.live.start();
    auto client = bench.client();
    client.reach(kSoon);
    const auto report = host_sim::verify_over_link(client, built_image());
    ASSERT_EQ(report.has_value(), !was_zero);
    EXPECT_EQ(report->first, 0x2345);
    EXPECT_EQ(report->found, 0x00);
    EXPECT_EQ(report->expected, built_image().bytes[0x2345]);
    EXPECT_EQ(report->count, 1u);
    EXPECT_EQ(flash_over_link(client, built_image(), {}).pages_written, 1u);
    EXPECT_FALSE(host_sim::verify_over_link(client, built_image()));
}

// TRAP cannot be masked, and its vector lies in the part that is being written: the gate is closed.
TEST(FlashOverLink, BumperAndUndervoltageDoNotDisturbIt) {
    using Kind = host_sim::Stimulus::Kind;
    LoaderBench bench;
    for (uint64_t t = 1; t < 20 * loader_test::kSecondT; t += 7001) {
        const bool bumper = t % 2 == 0;
        bench.live.board().schedule(
            {t, bumper ? Kind::bumper : Kind::undervoltage, 0, t / 7001 % 4 < 2 ? 1 : 0});
    }
    bench.live.start();
    auto client = bench.client();
    client.reach(kSoon);
    flash_over_link(client, built_image(), {});
    EXPECT_EQ(client.repeated(), 0u);
    bench.live.stop();
    EXPECT_TRUE(bench.holds(built_image()));
    EXPECT_EQ(bench.powered, 0u);
}

TEST(FlashOverLink, TheLargestImageIsClosedAtTheFirstRequest) {
    host_sim::Image image;
    image.file = "largest";
    for (unsigned at = 0x0C00; at < 0x7FC0; ++at) {
        image.put(static_cast<uint16_t>(at), static_cast<uint8_t>(at * 7 + at / 251));
    }
    const auto& built = built_image();
    const uint16_t block = read_identity(built).address;
    for (uint16_t at = block; at < block + 28; ++at) image.put(at, built.bytes[at]);
    host_sim::complete_for_board(image, host_sim::stamp_identity(image, {1, 2, 3}, 4), {});
    LoaderBench bench;
    bench.live.start();
    auto client = bench.client();
    client.reach(kSoon);
    EXPECT_EQ(flash_over_link(client, image, {}).pages, 463u);
    EXPECT_EQ(client.repeated(), 0u);
    bench.live.stop();
    EXPECT_TRUE(bench.holds(image));
    EXPECT_TRUE(bench.loader_is_untouched());
}

TEST(FlashOverLink, AnImageForAnotherVehicleIsRefusedUnlessMeant) {
    LoaderBench bench(true);
    bench.live.start();
    auto client = bench.client();
    client.reach(kSoon);
    EXPECT_THROW((void)flash_over_link(client, other_image(), {}), host_sim::FlashError);
    EXPECT_TRUE(client.hello().bootable) << "nothing was touched";
}

}  // namespace
