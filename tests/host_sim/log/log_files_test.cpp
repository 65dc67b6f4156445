// log_files_test.cpp - logs as files: which reader, RlogWriter and crashes, recover, odd paths.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include "host_sim/log/log_io.hpp"
#include "log_samples.hpp"

namespace {

namespace fs = std::filesystem;
using host_sim::encode_csv;
using host_sim::encode_rlog;
using host_sim::load_log;
using host_sim::Log;
using host_sim::LogError;
using host_sim::recover_rlog;
using host_sim::RlogWriter;
using log_test::small_log;

class LogFiles : public testing::Test {
protected:
    LogFiles() {
        std::string pattern = (fs::temp_directory_path() / "rover85-log-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
    }
    ~LogFiles() override { fs::remove_all(folder_); }

    [[nodiscard]] fs::path path(const std::string& name) const { return folder_ / name; }
    static void put(const fs::path& file, const std::string& bytes) {
        std::ofstream(file, std::ios::binary) << bytes;
    }
    static std::string get(const fs::path& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    [[nodiscard]] std::size_t file_count() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    static std::string error_of(const std::function<void()>& action) {
        try {
            action();
        } catch (const LogError& error) {
            return error.what();
        }
        return "accepted";
    }

    fs::path folder_;
};

TEST_F(LogFiles, TheContentDecidesWhichReaderIsAsked) {
    put(path("named.csv"), encode_rlog(small_log()));
    put(path("named.rlog"), encode_csv(small_log()));
    EXPECT_TRUE(log_test::same(load_log(path("named.csv")), small_log()));
    EXPECT_TRUE(log_test::same(load_log(path("named.rlog")), small_log()));
}

TEST_F(LogFiles, WriteAndLoadGiveTheSameLogAndLeaveNoOtherFile) {
    put(path("a.rlog"), "an older file");
    host_sim::write_rlog(path("a.rlog"), small_log());
    host_sim::write_csv(path("a.csv"), small_log());
    EXPECT_TRUE(log_test::same(load_log(path("a.rlog")), small_log()));
    EXPECT_TRUE(log_test::same(load_log(path("a.csv")), small_log()));
    EXPECT_EQ(file_count(), 2u);
}

TEST_F(LogFiles, AFailedWriteLeavesTheOlderFileAlone) {
    put(path("a.rlog"), "an older file");
    Log wrong = small_log();
    wrong.steps[2].time_ms = 0;
    EXPECT_EQ(error_of([&] {
                  host_sim::write_rlog(path("a.rlog"), wrong);
              }).rfind(path("a.rlog").string() + ": step at 0 ms", 0),
              0u);
    EXPECT_EQ(get(path("a.rlog")), "an older file");
    EXPECT_EQ(file_count(), 1u);
}

TEST_F(LogFiles, OddPathsAreRefusedWithTheReason) {
    EXPECT_EQ(
        error_of([&] { load_log(path("none")); }),
        path("none").string() + ": cannot be opened: No such file or directory; check the path");
    EXPECT_EQ(error_of([&] { load_log(folder_); }),
              folder_.string() + ": cannot be read: Is a directory; name a file in it");
    put(path("empty"), "");
    EXPECT_EQ(error_of([&] { load_log(path("empty")); }),
              path("empty").string() + ": the file is empty; give an .rlog or a wide CSV");
    put(path("cut"), encode_rlog(small_log()).substr(0, 5));
    EXPECT_NE(
        error_of([&] { load_log(path("cut")); }).find(":byte 5: the file ends inside its header"),
        std::string::npos);
    put(path("foreign"),
        "\x7F"
        "ELF\x02\n");
    EXPECT_NE(error_of([&] { load_log(path("foreign")); }).find("foreign:1: not a rover85 log"),
              std::string::npos);
    EXPECT_NE(error_of([&] {
                  host_sim::write_csv(path("no/folder.csv"), small_log());
              }).find("folder.csv: cannot be written: No such file"),
              std::string::npos);
    EXPECT_NE(error_of([&] { host_sim::write_csv(folder_, small_log()); }).find("Is a directory"),
              std::string::npos);
}

TEST_F(LogFiles, AFileBeyondTwoGigabytesIsRefusedBeforeItIsRead) {
    put(path("huge"), "time_ms\n");
    fs::resize_file(path("huge"), (std::uintmax_t{1} << 31) + 1);  // sparse: takes no space
    EXPECT_EQ(
        error_of([&] { load_log(path("huge")); }),
        path("huge").string() + ": is larger than 2 GiB; split the recording into shorter logs");
}

TEST_F(LogFiles, AWriteThatStopsHalfWayLeavesNoFileBehind) {
    // RLIMIT_FSIZE makes the write itself fail, after the file beside the target was created.
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        ::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{100, 100};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        const std::string error =
            error_of([&] { host_sim::write_rlog(path("a.rlog"), small_log()); });
        ::_exit(error.find("File too large") != std::string::npos ? 0 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "the error was not reported";
    EXPECT_EQ(file_count(), 0u);
}

TEST_F(LogFiles, WritingThroughALinkReplacesTheFileItNames) {
    put(path("target.csv"), "an older file");
    fs::create_symlink(path("target.csv"), path("link.csv"));
    host_sim::write_csv(path("link.csv"), small_log());
    EXPECT_TRUE(fs::is_symlink(path("link.csv")));
    EXPECT_TRUE(log_test::same(load_log(path("target.csv")), small_log()));
}

TEST_F(LogFiles, AFullDiskIsReported) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
    EXPECT_NE(
        error_of([] { host_sim::write_rlog("/dev/full", small_log()); }).find("No space left"),
        std::string::npos);
    EXPECT_NE(
        error_of([] { RlogWriter writer("/dev/full", small_log().head); }).find("No space left"),
        std::string::npos);
}

TEST_F(LogFiles, WriterGivesTheSameBytesAsTheEncoder) {
    for (const std::size_t flush_size : {std::size_t{0}, std::size_t{1000}, std::size_t{65536}}) {
        RlogWriter writer(path("w.rlog"), small_log().head, flush_size);
        for (const auto& step : small_log(9).steps) writer.append(step);
        writer.close();
        EXPECT_EQ(get(path("w.rlog")), encode_rlog(small_log(9))) << flush_size;
    }
    {
        RlogWriter unclosed(path("w.rlog"), small_log().head);
    }
    EXPECT_EQ(get(path("w.rlog")), encode_rlog(small_log(0)))
        << "the destructor writes what is left";
}

TEST_F(LogFiles, WriterKeepsAReadableFileAtAnyTime) {
    RlogWriter writer(path("w.rlog"), small_log().head, 1000);
    EXPECT_EQ(load_log(path("w.rlog")).steps.size(), 0u) << "the head is there at once";
    for (const auto& step : small_log(20).steps) {
        writer.append(step);
        EXPECT_LE(load_log(path("w.rlog")).steps.size(), 20u);
    }
    writer.flush();
    EXPECT_TRUE(log_test::same(load_log(path("w.rlog")), small_log(20)));
}

TEST_F(LogFiles, ARefusedStepLeavesTheWriterUsable) {
    const Log log = small_log(3);
    RlogWriter writer(path("w.rlog"), log.head);
    writer.append(log.steps[0]);
    EXPECT_NE(error_of([&] { writer.append(log.steps[0]); }).find("time must increase"),
              std::string::npos);
    writer.append(log.steps[1]);
    writer.append(log.steps[2]);
    writer.close();
    EXPECT_TRUE(log_test::same(load_log(path("w.rlog")), log));
    EXPECT_NE(error_of([&] { writer.append(log.steps[2]); }).find("after close()"),
              std::string::npos);
}

TEST_F(LogFiles, AKilledRecordingReadsUpToTheLastWholeRecord) {
    int pipe_ends[2];
    ASSERT_EQ(::pipe(pipe_ends), 0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        RlogWriter writer(path("killed.rlog"), small_log().head, 0);
        host_sim::LogStep step = small_log(1).steps[0];
        for (int i = 0;; ++i) {
            writer.append(step);
            ++step.time_ms;
            if (i == 200 && ::write(pipe_ends[1], "x", 1) != 1) ::_exit(1);
        }
    }
    char ready = 0;
    ASSERT_EQ(::read(pipe_ends[0], &ready, 1), 1);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const host_sim::Recovery recovery = recover_rlog(path("killed.rlog"), path("out.rlog"));
    EXPECT_GE(recovery.steps, 201u);
    EXPECT_EQ(load_log(path("out.rlog")).steps.size(), recovery.steps);
}

TEST_F(LogFiles, RecoverSalvagesExactlyTheWholeRecordsOfEveryTruncation) {
    const std::string bytes = encode_rlog(small_log(2));
    const std::size_t ends[] = {encode_rlog(small_log(0)).size(), encode_rlog(small_log(1)).size(),
                                bytes.size()};
    for (std::size_t size = 0; size <= bytes.size(); ++size) {
        host_sim::Recovery recovery;
        const std::string cut = bytes.substr(0, size);
        if (size < ends[0]) {
            EXPECT_THROW(host_sim::salvage_rlog(cut, "x", recovery), LogError) << size;
            continue;
        }
        const std::uint64_t steps = size < ends[1] ? 0 : size < ends[2] ? 1 : 2;
        const std::string_view kept = host_sim::salvage_rlog(cut, "x", recovery);
        EXPECT_EQ(kept, bytes.substr(0, ends[steps])) << size;
        EXPECT_EQ(recovery.steps, steps) << size;
        EXPECT_EQ(recovery.kept_bytes, ends[steps]) << size;
        EXPECT_EQ(recovery.dropped_bytes, size - ends[steps]) << size;
        EXPECT_EQ(recovery.reason.empty(), size == ends[steps]) << size;
    }
}

TEST_F(LogFiles, RecoverWritesAFileThatReadsAndSaysWhatItDropped) {
    const std::string bytes = encode_rlog(small_log(3));
    put(path("torn.rlog"), bytes.substr(0, bytes.size() - 10));
    put(path("out.rlog"), "an older file");
    const host_sim::Recovery recovery = recover_rlog(path("torn.rlog"), path("out.rlog"));
    EXPECT_EQ(recovery.steps, 2u);
    EXPECT_EQ(recovery.kept_bytes + recovery.dropped_bytes, bytes.size() - 10);
    EXPECT_NE(recovery.reason.find("the file ends inside record 3"), std::string::npos);
    EXPECT_TRUE(log_test::same(load_log(path("out.rlog")), small_log(2)));
}

TEST_F(LogFiles, RecoverRefusesWhatItCannotSalvage) {
    put(path("a.rlog"), encode_rlog(small_log()));
    put(path("a.csv"), encode_csv(small_log()));
    fs::create_hard_link(path("a.rlog"), path("same.rlog"));
    EXPECT_NE(
        error_of([&] { recover_rlog(path("a.rlog"), path("a.rlog")); }).find("damaged log itself"),
        std::string::npos);
    EXPECT_NE(error_of([&] {
                  recover_rlog(path("a.rlog"), path("same.rlog"));
              }).find("damaged log itself"),
              std::string::npos);
    EXPECT_NE(error_of([&] { recover_rlog(path("a.csv"), path("out")); }).find("not an .rlog"),
              std::string::npos);
    EXPECT_NE(error_of([&] { recover_rlog(path("none"), path("out")); }).find("cannot be opened"),
              std::string::npos);
    put(path("head.rlog"), encode_rlog(small_log()).substr(0, 40));
    EXPECT_NE(error_of([&] {
                  recover_rlog(path("head.rlog"), path("out"));
              }).find("nothing can be salvaged"),
              std::string::npos);
    EXPECT_FALSE(fs::exists(path("out")));
}

}  // namespace
