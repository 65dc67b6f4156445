// A session at a pseudo-terminal whose other end is played by the test.
#include "tools/monitor/session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <memory>
#include <sstream>
#include <thread>

#include "host_sim/link/pseudo_terminal.hpp"
#include "tests/tools/monitor/frames.hpp"

namespace {

using host_sim::PseudoTerminal;
using host_sim::SerialPort;
using monitor::MonitorError;
using monitor::Session;
using monitor::SessionOptions;
using monitor_test::Bytes;
using std::chrono::milliseconds;
using testing::HasSubstr;

/// A rover with a step each 10 ms, so that tests are short; answers what it is asked.
class Rover {
public:
    explicit Rover(PseudoTerminal& line) : line_(line), thread_([this] { run(); }) {}
    ~Rover() {
        stopping_ = true;
        thread_.join();
    }
    Rover(const Rover&) = delete;
    Rover& operator=(const Rover&) = delete;

    std::atomic<uint16_t> step = 0;
    std::atomic<bool> silent = false;
    std::atomic<int> identities_asked = 0, statuses_asked = 0;

private:
    void run() {
        Bytes asked;
        while (!stopping_) {
            if (!silent) line_.write(monitor_test::telemetry(step++));
            const Bytes more = line_.read(100);
            asked.insert(asked.end(), more.begin(), more.end());
            for (; asked.size() >= 6; asked.erase(asked.begin(), asked.begin() + 6)) {
                EXPECT_EQ(asked[0], 0xC5);
                EXPECT_EQ(asked[1], 0x3A);
                identities_asked += asked[2] == 1 ? 1 : 0;
                statuses_asked += asked[2] == 2 ? 1 : 0;
                line_.write(asked[2] == 1 ? monitor_test::identity() : monitor_test::status());
            }
            std::this_thread::sleep_for(milliseconds(10));
        }
    }

    PseudoTerminal& line_;
    std::atomic<bool> stopping_ = false;
    std::thread thread_;
};

SessionOptions options(double seconds) {
    SessionOptions made;
    made.name = "the port";
    made.seconds = seconds;
    made.wait_s = 0.2;
    return made;
}

std::string error_of(Session& session) {
    try {
        session.run();
    } catch (const MonitorError& error) {
        return error.what();
    }
    return "none";
}

TEST(Session, AsksWhoItIsThenForItsStatusAndShowsTheFrames) {
    PseudoTerminal line;
    SerialPort port(line.path());
    std::ostringstream out;
    const Rover rover(line);
    SessionOptions chosen = options(20);
    const Session* running = nullptr;
    chosen.ended = [&] { return running->known().status && rover.step > 20; };
    Session session(port, chosen, out);
    running = &session;
    session.run();
    EXPECT_EQ(rover.identities_asked, 1);
    EXPECT_EQ(rover.statuses_asked, 1);
    EXPECT_THAT(out.str(), HasSubstr("identity: rover85 1.2.3 sources 89abcdef"));
    EXPECT_THAT(out.str(), HasSubstr("status: reset 7: watchdog, warm start"));
    EXPECT_THAT(out.str(), HasSubstr("step 3 0.3 s: position -"));
    EXPECT_THAT(out.str(), HasSubstr(" telemetry frames, 0 steps missing, 0 frames refused, "));
    EXPECT_GE(session.known().counts.telemetry, 10u);
}

TEST(Session, EndsWhenItIsToldTo) {
    PseudoTerminal line;
    SerialPort port(line.path());
    std::ostringstream out;
    const Rover rover(line);
    SessionOptions chosen = options(1000);
    chosen.ended = [&rover] { return rover.step > 20; };
    Session session(port, chosen, out);
    session.run();
    EXPECT_THAT(out.str(), HasSubstr("telemetry frames"));
}

TEST(Session, GapsAndRestartsAreSaid) {
    PseudoTerminal line;
    SerialPort port(line.path());
    std::ostringstream out;
    line.write(monitor_test::telemetry(5, 800));
    line.write(monitor_test::telemetry(9, 800));
    line.write(monitor_test::telemetry(0, 0));
    Session session(port, options(0.5), out);
    session.run();
    EXPECT_THAT(out.str(), HasSubstr("\nno telemetry of 3 steps before step 9\n"));
    EXPECT_THAT(out.str(), HasSubstr("\nthe rover was reset and has started cold\n"));
    EXPECT_THAT(out.str(), HasSubstr("3 telemetry frames, 3 steps missing"));
    EXPECT_THAT(out.str(), HasSubstr(" 1 restarts\n"));
}

TEST(Session, WithoutAByteItSaysWhatToCheck) {
    PseudoTerminal line;
    SerialPort port(line.path());
    std::ostringstream out;
    Session session(port, options(1000), out);
    const std::string error = error_of(session);
    EXPECT_THAT(error, HasSubstr("the port: no telemetry within 0.2 s, not a single byte; check"));
    EXPECT_THAT(error, HasSubstr("power"));
    EXPECT_THAT(error, HasSubstr("TX and RX"));
    EXPECT_THAT(error, HasSubstr("rover85 flash"));
    EXPECT_EQ(out.str(), "");
    EXPECT_TRUE(line.read(100).empty()) << "nothing is sent to who may be waiting for an image";
}

TEST(Session, GarbageIsNamedAsSuch) {
    PseudoTerminal line;
    SerialPort port(line.path());
    std::ostringstream out;
    line.write(Bytes(77, 0xF8));
    Session session(port, options(1000), out);
    EXPECT_THAT(error_of(session),
                HasSubstr("77 bytes came within 0.2 s, but no telemetry frame; check that the "
                          "other side sends at 19,200 baud"));
}

TEST(Session, ASilenceIsSaidOnce) {
    PseudoTerminal line;
    SerialPort port(line.path());
    std::ostringstream out;
    Rover rover(line);
    SessionOptions chosen = options(30);
    std::atomic<uint16_t> enough = 65535;
    std::thread hush([&] {
        while (rover.step < 10) std::this_thread::sleep_for(milliseconds(1));
        rover.silent = true;
        std::this_thread::sleep_for(milliseconds(3500));
        enough = static_cast<uint16_t>(rover.step + 10);
        rover.silent = false;
    });
    chosen.ended = [&] { return rover.step > enough; };
    Session session(port, chosen, out);
    session.run();
    hush.join();
    const std::string note = "no telemetry for 3 s; still listening\n";
    const std::size_t first = out.str().find(note);
    ASSERT_NE(first, std::string::npos);
    EXPECT_EQ(out.str().find(note, first + 1), std::string::npos);
    EXPECT_NE(out.str().find("\nstep", first), std::string::npos) << "and it went on";
}

TEST(Session, ARecordingIsWholeAlsoWhenThePortGoesAway) {
    const auto path = std::filesystem::temp_directory_path() / "rover85_session.csv";
    auto line = std::make_unique<PseudoTerminal>();
    SerialPort port(line->path());
    std::ostringstream out;
    for (uint16_t step = 0; step < 10; ++step) line->write(monitor_test::telemetry(step));
    SessionOptions chosen = options(1000);
    chosen.record = path.string();
    Session session(port, chosen, out);
    std::thread unplug([&line] {
        std::this_thread::sleep_for(milliseconds(500));
        line.reset();
    });
    EXPECT_THROW(session.run(), host_sim::SerialError);
    unplug.join();
    const host_sim::Log log = host_sim::load_log(path);
    EXPECT_FALSE(log.unverified);
    EXPECT_EQ(log.steps.size(), 10u);
    EXPECT_THAT(out.str(), HasSubstr("recorded: 10 steps in "));
    std::filesystem::remove(path);
}

}  // namespace
