// vcd_writer_test.cpp - VCD files, read back by a strict parser of their grammar.
#include "host_sim/trace/vcd_writer.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "vcd_parser.hpp"

namespace {

namespace fs = std::filesystem;
using host_sim::ns_from_t;
using host_sim::VcdError;
using host_sim::VcdWriter;
using trace_test::VcdChange;
using trace_test::VcdFile;
using trace_test::VcdParser;
using Changes = std::vector<VcdChange>;

class VcdWriterTest : public testing::Test {
protected:
    VcdWriterTest() {
        std::string pattern = (fs::temp_directory_path() / "rover85-vcd-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
        path_ = folder_ / "a.vcd";
    }
    ~VcdWriterTest() override { fs::remove_all(folder_); }

    [[nodiscard]] std::string text() const {
        std::ifstream in(path_, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    [[nodiscard]] VcdFile file() const { return VcdParser(text()).parse(); }

    fs::path folder_;
    fs::path path_;
};

TEST_F(VcdWriterTest, TheFileAsAWhole) {
    {
        VcdWriter vcd(path_, 1'000'000'000);  // a T-state is a nanosecond
        const auto clock = vcd.add_signal("board.cpu", "ready", 1, 1);
        const auto data = vcd.add_signal("board", "data", 8);
        vcd.change(data, 0x2A, 5);
        vcd.change(clock, 0, 5);
        vcd.change(clock, 0, 6);  // unchanged
        vcd.change(clock, 1, 9);
        vcd.close(20);
    }
    EXPECT_EQ(text(),
              "$version rover85 $end\n$timescale 1 ns $end\n"
              "$scope module board $end\n$var wire 8 \" data $end\n"
              "$scope module cpu $end\n$var wire 1 ! ready $end\n$upscope $end\n$upscope $end\n"
              "$enddefinitions $end\n#0\n$dumpvars\n1!\nbx \"\n$end\n"
              "#5\nb101010 \"\n0!\n#9\n1!\n#20\n");
    const VcdFile read = file();
    EXPECT_EQ(read.changes.at("board.data"), (Changes{{0, "x"}, {5, "101010"}}));
    EXPECT_EQ(read.changes.at("board.cpu.ready"), (Changes{{0, "1"}, {5, "0"}, {9, "1"}}));
    EXPECT_EQ(read.end, 20u);
}

TEST(VcdTime, IsTheNearestNanosecond) {
    // 3.072 MHz: a T-state is 325.520833.. ns.
    EXPECT_EQ(ns_from_t(0, 3'072'000), 0u);
    EXPECT_EQ(ns_from_t(1, 3'072'000), 326u);
    EXPECT_EQ(ns_from_t(2, 3'072'000), 651u);
    EXPECT_EQ(ns_from_t(3'072'000, 3'072'000), 1'000'000'000u);
    // A day later nothing has drifted: 86400 s and one T-state.
    EXPECT_EQ(ns_from_t(86'400ull * 3'072'000 + 1, 3'072'000), 86'400'000'000'326u);
    EXPECT_EQ(ns_from_t(1, 2'000'000), 500u);
    EXPECT_EQ(ns_from_t(1, 400'000'000), 3u);  // 2.5: half up
}

TEST_F(VcdWriterTest, AnUnusedFileIsValidToo) {
    {
        VcdWriter vcd(path_, 3'072'000);
    }
    EXPECT_EQ(file().widths.size(), 0u);
    {
        VcdWriter vcd(path_, 3'072'000);
        vcd.add_signal("", "lone", 16, 0x1FFFF);
    }
    EXPECT_EQ(file().changes.at("lone"), (Changes{{0, "1111111111111111"}}));
}

TEST_F(VcdWriterTest, ManySignalsHaveDifferentCodes) {
    {
        VcdWriter vcd(path_, 1'000'000);
        for (int i = 0; i < 10'000; ++i) {
            std::string name = std::to_string(i);
            name += 's';
            vcd.add_signal(i % 3 == 0 ? "a" : "a.b", name, 1, 0);
        }
        vcd.change(9'999, 1, 1);
    }
    const VcdFile read = file();
    EXPECT_EQ(read.widths.size(), 10'000u);
    EXPECT_EQ(read.changes.at("a.9999s"), (Changes{{0, "0"}, {1000, "1"}}));
}

TEST_F(VcdWriterTest, MisuseIsRefused) {
    EXPECT_THROW(VcdWriter(path_, 0), std::invalid_argument);
    EXPECT_THROW(VcdWriter(path_, 1'000'000'001), std::invalid_argument);
    VcdWriter vcd(path_, 1'000'000);
    EXPECT_THROW(vcd.add_signal("a", "b c", 1), std::invalid_argument);
    EXPECT_THROW(vcd.add_signal("a b", "c", 1), std::invalid_argument);
    EXPECT_THROW(vcd.add_signal("a..b", "c", 1), std::invalid_argument);
    EXPECT_THROW(vcd.add_signal("a", "", 1), std::invalid_argument);
    EXPECT_THROW(vcd.add_signal("a", "b", 0), std::invalid_argument);
    EXPECT_THROW(vcd.add_signal("a", "b", 65), std::invalid_argument);
    const auto signal = vcd.add_signal("a", "b", 64);
    vcd.change(signal, UINT64_MAX, 10);
    EXPECT_THROW(vcd.add_signal("a", "c", 1), std::logic_error);
    EXPECT_THROW(vcd.change(signal, 0, 9), std::logic_error);
    EXPECT_THROW(vcd.close(9), std::logic_error);
    vcd.close();
    EXPECT_THROW(vcd.change(signal, 0, 11), std::logic_error);
    EXPECT_EQ(file().changes.at("a.b").back().value, std::string(64, '1'));
}

TEST_F(VcdWriterTest, PlacesThatCannotBeWrittenAreNamed) {
    try {
        VcdWriter vcd(folder_ / "none" / "a.vcd", 1'000'000);
        FAIL() << "accepted";
    } catch (const VcdError& error) {
        EXPECT_EQ(std::string(error.what()), (folder_ / "none" / "a.vcd").string() +
                                                 ": cannot be written: No such file or directory");
    }
    VcdWriter full("/dev/full", 1'000'000);
    const auto signal = full.add_signal("", "a", 1);
    full.change(signal, 1, 1);
    EXPECT_THROW(full.close(), VcdError);
}

RC_GTEST_PROP(VcdWriterProperty, WhatIsReadBackIsWhatWasChanged, ()) {
    const fs::path path = fs::temp_directory_path() / ("rover85-vcd-" + std::to_string(::getpid()));
    const uint64_t clock_hz = *rc::gen::inRange<uint64_t>(1'000'000, 20'000'000);
    const auto width = *rc::gen::inRange(1u, 65u);
    const auto count = *rc::gen::inRange(0, 100);
    Changes expected = {{0, "x"}};
    {
        VcdWriter vcd(path, clock_hz);
        const auto signal = vcd.add_signal("s", "v", width);
        uint64_t t = 0;
        std::optional<uint64_t> last;
        for (int i = 0; i < count; ++i) {
            t += *rc::gen::inRange<uint64_t>(1, 1000);
            const uint64_t value = *rc::gen::arbitrary<uint64_t>() & (~uint64_t{0} >> (64 - width));
            vcd.change(signal, value, t);
            if (value == last) continue;
            last = value;
            std::string digits;
            for (uint64_t rest = value; rest != 0; rest >>= 1) {
                digits.insert(digits.begin(), rest % 2 != 0 ? '1' : '0');
            }
            const long double ns = static_cast<long double>(t) * 1e9L / clock_hz;
            expected.push_back({static_cast<uint64_t>(ns + 0.5L), digits.empty() ? "0" : digits});
        }
    }
    std::ifstream in(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    fs::remove(path);
    RC_ASSERT(VcdParser(text).parse().changes.at("s.v") == expected);
}

/// Memory that a child process and this one share.
struct Progress {
    std::atomic<uint64_t> recorded = 0;  ///< last T-state whose change() has returned
};

[[noreturn]] void write_until_killed(const fs::path& path, Progress& progress) {
    host_sim::flush_vcd_on_signals();
    VcdWriter vcd(path, 1'000'000'000);
    const auto counter = vcd.add_signal("", "counter", 64, 0);
    for (uint64_t t = 1;; ++t) {
        vcd.change(counter, t, t);
        progress.recorded = t;
    }
}

TEST_F(VcdWriterTest, AKilledProcessLeavesEveryRecordItMade) {
    void* memory = ::mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE,
                          MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(memory, MAP_FAILED);
    auto* progress = new (memory) Progress;
    for (const int signal : {SIGTERM, SIGINT, SIGTERM, SIGINT, SIGTERM}) {
        progress->recorded = 0;
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) write_until_killed(path_, *progress);
        // At least one full buffer, and a different place in it each time.
        while (progress->recorded < 10'000) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        ::kill(child, signal);
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        ASSERT_TRUE(WIFSIGNALED(status));
        EXPECT_EQ(WTERMSIG(status), signal);
        const auto changes = file().changes.at("counter");
        // The signal may come between a record and the note of it.
        EXPECT_GE(changes.back().time, progress->recorded);
        EXPECT_LE(changes.back().time, progress->recorded + 1);
        ASSERT_EQ(changes.size(), changes.back().time + 1);  // none lost, none twice
    }
    ::munmap(memory, sizeof(Progress));
}

}  // namespace
