// broken_transfers_test.cpp - a thousand transfers that break: at any byte, by a reset or a loss of
// power at any T-state, by noise on the line. Whatever happened, the loader answers, what is
// bootable is whole, and the same command brings the image in.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <mutex>
#include <random>
#include <thread>

#include "firmware/config/eeprom_layout.hpp"
#include "tests/system/loader/loader_bench.hpp"

namespace {

using host_sim::Board;
using host_sim::ByteLine;
using host_sim::Image;
using host_sim::LoaderClient;
using loader_test::LoaderBench;
using std::chrono::milliseconds;
namespace layout = rover::loader;

constexpr unsigned kTrials = 1000;
constexpr unsigned kThreads = 8;  // they mostly wait for one another's PC

/// An image of `pages` pages: identity block in the first, random bytes behind. Nobody runs it.
Image made_up_image(unsigned pages, unsigned seed) {
    std::mt19937 random(seed);
    Image image;
    image.file = "made up";
    for (std::size_t i = 0; i < pages * layout::kPageSize - 5; ++i) {
        image.put(static_cast<uint16_t>(layout::kApplicationFirst + i),
                  static_cast<uint8_t>(random()));
    }
    image.put(layout::kApplicationFirst, 0x76);  // HLT, if it is ever started
    constexpr std::string_view kBlock{"ROVER85\0\1\0\0\0\0\0\0\0\0\0\0\0Rocky3.2", 28};
    uint16_t at = layout::kApplicationFirst + 16;
    for (const char byte : kBlock) image.put(at++, static_cast<uint8_t>(byte));
    const auto identity = host_sim::stamp_identity(image, {0, 0, 1}, seed);
    Image loader;
    for (uint16_t i = 0; i <= layout::kLoaderLast; ++i) {
        if (loader_test::built_image().present[i]) {
            loader.put(i, loader_test::built_image().bytes[i]);
        }
    }
    host_sim::complete_for_board(image, identity, loader);
    return image;
}

enum class Break { host_ends, reset, power, noise_to_board, noise_to_host };
constexpr std::array kBreakNames = {"host ends", "reset", "power", "noise to the board",
                                    "noise to the host"};

struct HostEnds {};

/// The line as it is, but for what goes wrong on it.
ByteLine breaking(ByteLine line, Break kind, std::size_t at) {
    auto sent = std::make_shared<std::size_t>(0);
    auto came = std::make_shared<std::size_t>(0);
    ByteLine broken;
    broken.write = [=, write = line.write](std::span<const uint8_t> bytes) {
        std::vector<uint8_t> copy(bytes.begin(), bytes.end());
        const bool here = at >= *sent && at < *sent + copy.size();
        if (here && kind == Break::noise_to_board) copy[at - *sent] ^= 0x24;
        if (here && kind == Break::host_ends) {
            copy.resize(at - *sent);
            if (!copy.empty()) write(copy);
            throw HostEnds{};
        }
        *sent += copy.size();
        write(copy);
    };
    broken.read = [=, read = line.read](std::span<uint8_t> buffer, milliseconds timeout) {
        const std::size_t count = read(buffer, timeout);
        const bool here = at >= *came && at < *came + count;
        if (here && kind == Break::noise_to_host) buffer[at - *came] ^= 0x24;
        *came += count;
        return count;
    };
    return broken;
}

/// Is there a valid boot record? By the page's bytes, apart from the code under test.
bool has_boot_record(const Board& board) {
    const uint8_t* record = board.state.eeprom.data() + layout::kRecordPage;
    const uint16_t crc = host_sim::link_crc({record, 10});
    return std::equal(record, record + 4, "R85B") && record[10] == (crc & 0xFF) &&
           record[11] == crc >> 8;
}

struct Tally {
    std::mutex mutex;
    std::array<unsigned, kBreakNames.size()> trials{};
    unsigned left_bootable = 0, resumed = 0;
    uint64_t samples = 0;
};

class Trial {
public:
    Trial(unsigned seed, Tally& tally) : random_(seed), seed_(seed), tally_(tally) {}

    void run() {
        const Image before = made_up_image(10, 1);
        const Image after = made_up_image(12, 2);
        bench_.live.board().program(std::span(before.bytes).first(hal::rb85::kEepromLast + 1));
        if (random_() % 4 == 0) bench_.live.board().program(std::array<uint8_t, 64>{}, 0x7FC0);
        const auto kind = static_cast<Break>(random_() % kBreakNames.size());
        if (kind == Break::reset || kind == Break::power) plan_break(kind);
        bench_.live.start();
        flash(breaking(bench_.line(), kind, random_() % 1100), after);
        bench_.live.stop();
        check_invariants(before, after);
        bench_.live.start();
        try {
            flash_to_the_end(after);
        } catch (const std::exception& error) {
            ADD_FAILURE() << describe(kind) << ": " << error.what();
        }
        bench_.live.stop();
        EXPECT_TRUE(bench_.holds(after)) << describe(kind);
        EXPECT_TRUE(bench_.loader_is_untouched()) << describe(kind);
        EXPECT_EQ(bench_.powered, 0u) << describe(kind);
        const std::scoped_lock lock(tally_.mutex);
        ++tally_.trials[static_cast<std::size_t>(kind)];
        tally_.samples += bench_.samples;
    }

private:
    std::string describe(Break kind) const {
        return "seed " + std::to_string(seed_) + ", " + kBreakNames[static_cast<std::size_t>(kind)];
    }

    /// Within the transfer, or before or behind it.
    void plan_break(Break kind) {
        const uint64_t t = random_() % (loader_test::kSecondT * 5 / 4);
        bench_.live.at(t, [kind](Board& board) {
            if (kind == Break::reset) board.reset();
            if (kind == Break::power) board.power_cycle();
        });
    }

    static constexpr LoaderClient::Options kPatience{
        .answer = milliseconds(400), .tries = 2, .close = milliseconds(400)};

    /// As far as it gets.
    void flash(const ByteLine& line, const Image& image) {
        LoaderClient client(line, kPatience);
        try {
            client.reach(milliseconds(20'000));
            const auto result = flash_over_link(client, image, {});
            const std::scoped_lock lock(tally_.mutex);
            tally_.resumed += result.resumed;
        } catch (const HostEnds&) {
        } catch (const host_sim::LoaderError&) {
        } catch (const host_sim::FlashError&) {
        }
    }

    void flash_to_the_end(const Image& image) {
        LoaderClient client(bench_.line(), kPatience);
        client.reach(milliseconds(60'000));
        flash_over_link(client, image, {.lost = [&client] {
                            client.reach(milliseconds(20'000));
                            return true;
                        }});
    }

    void check_invariants(const Image& before, const Image& after) {
        if (!has_boot_record(bench_.live.board())) return;
        EXPECT_TRUE(bench_.holds(before) || bench_.holds(after)) << "seed " << seed_;
        const std::scoped_lock lock(tally_.mutex);
        ++tally_.left_bootable;
    }

    std::mt19937 random_;
    unsigned seed_;
    Tally& tally_;
    LoaderBench bench_;
};

TEST(BrokenTransfers, AThousandLeaveABoardThatAnswersAndCanBeFlashed) {
    const char* chosen = std::getenv("ROVER_FLASH_SEED");
    const unsigned first_seed = chosen != nullptr
                                    ? static_cast<unsigned>(std::strtoul(chosen, nullptr, 10))
                                    : std::random_device{}() % 1'000'000;
    std::printf("seeds from %u\n", first_seed);
    Tally tally;
    std::atomic<unsigned> next = 0;
    std::vector<std::thread> threads;
    for (unsigned i = 0; i < kThreads; ++i) {
        threads.emplace_back([&] {
            for (unsigned trial = next++; trial < kTrials; trial = next++) {
                Trial(first_seed + trial, tally).run();
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (std::size_t i = 0; i < kBreakNames.size(); ++i) {
        std::printf("%s: %u\n", kBreakNames[i], tally.trials[i]);
        EXPECT_GT(tally.trials[i], kTrials / 8);
    }
    std::printf(
        "left with a bootable image: %u; resumed by the host itself: %u; %llu samples of "
        "the motors\n",
        tally.left_bootable, tally.resumed, static_cast<unsigned long long>(tally.samples));
    EXPECT_GT(tally.left_bootable, kTrials / 20);
    EXPECT_LT(tally.left_bootable, kTrials);
}

}  // namespace
