// debug_test.cpp - `rover85 debug` as a user runs it: commands, scripts, files, exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <thread>

#include "tests/system/program.hpp"

namespace {

using system_test::Folder;
using system_test::Outcome;
using system_test::rover85;
using system_test::write_bytes;
using testing::HasSubstr;
using testing::StartsWith;

// 0000 MVI A,5 (7 T); 0002 STA 8000H (13 T); 0005 OUT 0F0H (10 T, no chip); 0007 JMP 0007H (10 T).
// The checksum is the two's complement of the sum of the record's bytes:
// 0A+3E+05+32+00+80+D3+F0+C3+07+00 = 38CH, so 74H.
constexpr const char* kHex = ":0A0000003E05320080D3F0C3070074\n:00000001FF\n";
constexpr const char* kSymbols = "0000 0007 F main\n0007 0003 F idle\n8000 0001 D mode\n";

class Debug : public testing::Test {
protected:
    Debug() {
        write_bytes(folder_ / "image.hex", kHex);
        write_bytes(folder_ / "image.sym", kSymbols);
    }
    Outcome debug(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"debug", folder_ / "image.hex"});
        return rover85(arguments);
    }
    Folder folder_;
};

TEST_F(Debug, CommandsRunInOrderAndTheProgramEnds) {
    const Outcome run = debug({"--command", "break idle", "--command", "continue", "--command",
                               "print [mode]", "--command", "violations"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err, "");
    EXPECT_EQ(run.out,
              "breakpoint 1: 0007H idle\n"
              "breakpoint 1: 0007H idle\n"
              "T 30 (0.010 ms), +30\n"
              ">* 0007  C3 07 00  JMP idle                    10 T  idle\n"
              "5 = 05H\n"
              "1 violation(s)\n"
              "first: OUT 0F0H of 05H to no chip, by 0005H main+5 at T 30 (0.010 ms)\n");
}

TEST_F(Debug, AScriptStopsAtItsErrorWithItsPlace) {
    write_bytes(folder_ / "boot.rb85", "# two steps\nstep 2\n\nbrek idle\nstep\n");
    const Outcome run = debug({"-x", folder_ / "boot.rb85", "--command", "step"});
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_THAT(run.out, StartsWith("T 20 (0.007 ms), +20\n"));
    EXPECT_EQ(run.err, "rover85: " + (folder_ / "boot.rb85") +
                           ":4: brek: no such command; `help` lists them\n");
    const Outcome command = debug({"--command", "step", "--command", "step x"});
    EXPECT_EQ(command.exit_code, 3);
    EXPECT_THAT(command.err, StartsWith("rover85: --command:2: x: no number"));
}

TEST_F(Debug, OptionsChooseProcessorMemoryAndStops) {
    EXPECT_THAT(debug({"--stop-at-violation", "--command", "run"}).out,
                StartsWith("violation: OUT 0F0H of 05H to no chip, by 0005H main+5"));
    write_bytes(folder_ / "undocumented.bin", "\x08\x76");
    const std::vector<std::string> arguments = {"debug", folder_ / "undocumented.bin",
                                                "--stop-at-halt", "--command", "run"};
    EXPECT_THAT(rover85(arguments).out, StartsWith("halted with interrupts disabled"));
    std::vector<std::string> documented = arguments;
    documented.insert(documented.end(), {"--cpu", "8085"});
    EXPECT_THAT(rover85(documented).out, StartsWith("08H at 0000H is no documented instruction"));
    write_bytes(folder_ / "ram.bin", "\x76");
    const Outcome ram = rover85({"debug", folder_ / "ram.bin", "--load", "8400H", "--ram", "2",
                                 "--command", "memory 8400H 1", "--command", "poke 8800H 1"});
    EXPECT_EQ(ram.exit_code, 3);
    EXPECT_THAT(ram.out, StartsWith("8400  76"));
    EXPECT_THAT(ram.err, HasSubstr("8800H: no memory there"));
    write_bytes(folder_ / "other.sym", "0007 0000 F spin\n");
    EXPECT_THAT(debug({"--symbols", folder_ / "other.sym", "--command", "symbols"}).out,
                StartsWith("0007  spin\n"));
}

/// Sends SIGINT to the processes that this one has started, again and again, once `file` exists.
class Interrupter {
public:
    explicit Interrupter(std::string file) : file_(std::move(file)) {}
    ~Interrupter() {
        done_ = true;
        thread_.join();
    }
    Interrupter(const Interrupter&) = delete;
    Interrupter& operator=(const Interrupter&) = delete;

private:
    void send() {
        const std::string self = std::to_string(getpid());
        while (!done_) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            if (!std::filesystem::exists(file_)) continue;
            std::ifstream children("/proc/" + self + "/task/" + self + "/children");
            for (pid_t child = 0; children >> child;) kill(child, SIGINT);
        }
    }
    std::string file_;
    std::atomic<bool> done_ = false;
    std::thread thread_{[this] { send(); }};
};

TEST_F(Debug, CtrlCStopsTheRunAndTheScript) {
    const std::string file = folder_ / "running.info";
    const Interrupter interrupter(file);
    const Outcome run =
        debug({"--command", "coverage on", "--command", "coverage " + file, "--command",
               "coverage off", "--command", "continue", "--command", "echo never"});
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_THAT(run.out, HasSubstr("\ninterrupted\n"));
    EXPECT_EQ(run.err, "rover85: --command:4: interrupted; the rest was not run\n");
}

TEST_F(Debug, WrongInputIsRefusedInOneLine) {
    const auto refused = [](const Outcome& run, const std::string& word) {
        EXPECT_EQ(run.exit_code, 3) << run.out;
        EXPECT_EQ(run.out, "");
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
        EXPECT_THAT(run.err, HasSubstr(word));
    };
    refused(rover85({"debug", folder_ / "absent.hex"}), "absent.hex");
    refused(debug({"--symbols", folder_ / "absent.sym"}), "absent.sym");
    refused(debug({"--load", "8000H", "--command", "step"}), "leave out --load");
    refused(debug({"-x", folder_ / "absent.rb85"}), "absent.rb85");
    write_bytes(folder_ / "torn.hex", std::string(kHex).substr(0, 20));
    refused(rover85({"debug", folder_ / "torn.hex", "--command", "step"}), "torn.hex");
    write_bytes(folder_ / "a.bin", "\x76");
    refused(rover85({"debug", folder_ / "a.bin", "--load", "here", "--command", "step"}),
            "--load here");
    refused(
        rover85({"debug", folder_ / "a.bin", "--load", "8800H", "--ram", "2", "--command", "step"}),
        "8800H");
}

TEST_F(Debug, WrongUsageIs2) {
    EXPECT_EQ(rover85({"debug"}).exit_code, 2);
    EXPECT_EQ(debug({"--cpu", "z80"}).exit_code, 2);
    EXPECT_EQ(debug({"--ram", "33"}).exit_code, 2);
    EXPECT_EQ(debug({"--ram", "0"}).exit_code, 2);
    EXPECT_EQ(debug({"--speed", "3"}).exit_code, 2);
}

TEST_F(Debug, HelpTeachesByExample) {
    const Outcome help = rover85({"debug", "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.out, HasSubstr("Examples:\n  rover85 debug rover85.hex\n"));
}

}  // namespace
