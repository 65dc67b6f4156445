// A live board with an echo program behind its pseudo-terminal: characters, pace, events, errors.
#include "host_sim/link/live_board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "host_sim/link/serial_port.hpp"
#include "tests/support/assemble.hpp"

namespace {

using host_sim::Board;
using host_sim::BoardOptions;
using host_sim::LiveBoard;
using host_sim::LiveBoardError;
using host_sim::Pace;
using host_sim::SerialPort;
using host_sim::Stimulus;
using std::chrono::milliseconds;
using Bytes = std::vector<uint8_t>;
using Clock = std::chrono::steady_clock;

constexpr milliseconds kSoon{5000};
constexpr uint64_t kSecondT = 3'072'000;
constexpr uint64_t kCharacterT = 1600;

// Sends every character back, plus 1; counts them at 8000H; each turn of the loop has an edge of
// SOD for the watchdog. 19,200 baud: counter 1, mode 3, count 10, with the USART's factor of 16.
constexpr const char* kEcho = R"(
UDATA   EQU 08H
UCTL    EQU 09H
        LXI  SP,0FF00H
        MVI  A,56H
        OUT  13H
        MVI  A,10
        OUT  11H
        MVI  A,4EH
        OUT  UCTL
        MVI  A,37H
        OUT  UCTL
        LXI  H,8000H
LOOP:   MVI  A,0C0H
        SIM
        MVI  A,40H
        SIM
        IN   UCTL
        ANI  2
        JZ   LOOP
        IN   UDATA
        INR  M
        INR  A
        MOV  B,A
SEND:   IN   UCTL
        ANI  1
        JZ   SEND
        MOV  A,B
        OUT  UDATA
        JMP  LOOP
)";

void load(Board& board, const char* source) {
    const auto code = test_support::assemble(source);
    board.program(code.bytes, code.origin);
}

Bytes read_count(SerialPort& port, std::size_t count) {
    Bytes bytes(count);
    std::size_t done = 0;
    while (done < count) {
        const std::size_t more = port.read(std::span(bytes).subspan(done), kSoon);
        if (more == 0) break;
        done += more;
    }
    bytes.resize(done);
    return bytes;
}

/// `count` bytes from `first` on, upwards.
Bytes counting(uint8_t first, std::size_t count) {
    Bytes bytes(count);
    std::iota(bytes.begin(), bytes.end(), first);
    return bytes;
}

/// A board that echoes, running.
struct Echo {
    explicit Echo(Pace pace) : live({}, pace) {
        load(live.board(), kEcho);
        live.start();
        // Until the program listens.
        while (live.elapsed_t() < 10'000) std::this_thread::sleep_for(milliseconds(1));
    }
    LiveBoard live;
};

/// What `look` says of the board, between two instructions.
template <class Look>
auto ask(LiveBoard& live, Look look) {
    std::promise<decltype(look(std::declval<Board&>()))> answer;
    auto result = answer.get_future();
    live.at(0, [&](Board& board) { answer.set_value(look(board)); });
    return result.get();
}

class LiveBoardPace : public testing::TestWithParam<Pace> {};

TEST_P(LiveBoardPace, EveryByteComesBackInOrder) {
    Echo echo(GetParam());
    SerialPort port(echo.live.path());
    port.write(counting(0, 256), kSoon);
    EXPECT_EQ(read_count(port, 256), counting(1, 256));
    echo.live.stop();
    EXPECT_EQ(echo.live.counts().received, 256u);
    EXPECT_EQ(echo.live.counts().sent, 256u);
    EXPECT_EQ(echo.live.counts().lost, 0u);
    EXPECT_EQ(echo.live.board().state.usart.overrun_count, 0u);
}

TEST_P(LiveBoardPace, UsersComeAndGo) {
    Echo echo(GetParam());
    for (int user = 0; user < 3; ++user) {
        SerialPort port(echo.live.path());
        port.write(Bytes{0x41}, kSoon);
        EXPECT_EQ(read_count(port, 1), Bytes{0x42}) << user;
    }
}

INSTANTIATE_TEST_SUITE_P(Both, LiveBoardPace, testing::Values(Pace::real_time, Pace::eager));

// The characters of one write follow each other without a gap: 10 bits of 160 T.
TEST(LiveBoard, CharactersComeBackToBackAt19200Baud) {
    Echo echo(Pace::real_time);
    SerialPort port(echo.live.path());
    port.write(counting(0, 40), kSoon);
    std::vector<uint64_t> starts;
    while (starts.size() < 2) {
        starts = ask(echo.live, [](Board& board) {
            std::vector<uint64_t> queued;
            for (const auto& stimulus : board.state.stimuli) queued.push_back(stimulus.t);
            return queued;
        });
    }
    for (std::size_t i = 1; i < starts.size(); ++i) {
        EXPECT_EQ(starts[i] - starts[i - 1], kCharacterT) << i;
    }
    EXPECT_EQ(read_count(port, 40), counting(1, 40));
}

// The same characters at the same T-states leave the same board, whoever runs it in which slices.
TEST(LiveBoard, DoesWhatTheBoardDoes) {
    const uint64_t end_t = kSecondT / 4;
    const auto feed = [](Board& board) {
        for (uint8_t i = 0; i < 50; ++i) {
            board.schedule({10'000 + kCharacterT * i, Stimulus::Kind::serial_byte, 0, i});
        }
    };
    Board expected;
    load(expected, kEcho);
    feed(expected);
    expected.run(end_t);
    (void)expected.take_transmitted();
    for (const Pace pace : {Pace::real_time, Pace::eager}) {
        LiveBoard live({}, pace);
        load(live.board(), kEcho);
        feed(live.board());
        for (uint64_t t = 777; t < end_t; t += 7'777) live.at(t, [](Board&) {});
        std::promise<void> over;
        bool same = false;
        live.at(end_t, [&](Board& board) {
            same = board.state == expected.state;
            over.set_value();
        });
        live.start();
        over.get_future().wait();
        live.stop();
        EXPECT_TRUE(same);
        EXPECT_EQ(live.counts().sent, 50u);
    }
}

TEST(LiveBoard, RealTimeFollowsTheClock) {
    Echo echo(Pace::real_time);
    const auto begin = Clock::now();
    while (echo.live.elapsed_t() < kSecondT / 2) std::this_thread::sleep_for(milliseconds(1));
    const auto took = Clock::now() - begin;
    EXPECT_GE(took, milliseconds(490));
    EXPECT_LT(took, milliseconds(2000)) << "a PC that runs something else may be late";
}

// 8 KB take 4.3 s of the board's time.
TEST(LiveBoard, EagerDoesNotWaitForCharacters) {
    Echo echo(Pace::eager);
    SerialPort port(echo.live.path());
    const auto begin = Clock::now();
    for (int block = 0; block < 32; ++block) {
        port.write(counting(0, 256), kSoon);
        ASSERT_EQ(read_count(port, 256), counting(1, 256));
    }
    EXPECT_GT(echo.live.elapsed_t(), 8192 * kCharacterT);
    EXPECT_LT(Clock::now() - begin, milliseconds(echo.live.elapsed_t() / 3072));
}

// While nothing moves, a second of the board is a second of the PC.
TEST(LiveBoard, EagerWaitsWhileNothingMoves) {
    Echo echo(Pace::eager);
    const auto begin = Clock::now();
    std::this_thread::sleep_for(milliseconds(300));
    const uint64_t t = echo.live.elapsed_t();
    const auto passed = std::chrono::duration_cast<milliseconds>(Clock::now() - begin);
    EXPECT_LT(t, (static_cast<uint64_t>(passed.count()) + 50) * 3072);
    EXPECT_GT(t, 100u * 3072);
}

// Sends 'U' for ever.
constexpr const char* kTalk = R"(
        MVI  A,56H
        OUT  13H
        MVI  A,10
        OUT  11H
        MVI  A,4EH
        OUT  09H
        MVI  A,37H
        OUT  09H
LOOP:   MVI  A,0C0H
        SIM
        MVI  A,40H
        SIM
        IN   09H
        ANI  1
        JZ   LOOP
        MVI  A,'U'
        OUT  08H
        JMP  LOOP
)";

TEST(LiveBoard, WhatNobodyReadsIsLostAndCounted) {
    for (const Pace pace : {Pace::real_time, Pace::eager}) {
        LiveBoard live({}, pace);
        load(live.board(), kTalk);
        live.start();
        while (live.counts().sent < 2500) std::this_thread::sleep_for(milliseconds(1));
        live.stop();
        const auto counts = live.counts();
        EXPECT_GE(counts.sent - counts.lost, 1024u);
        // The system counts them as unread a moment late.
        EXPECT_LE(counts.sent - counts.lost, 2 * host_sim::PseudoTerminal::kUnreadMax);
    }
}

TEST(LiveBoard, AnEagerBoardWaitsForItsReader) {
    LiveBoard live({}, Pace::eager);
    load(live.board(), kTalk);
    live.start();
    SerialPort port(live.path());
    Bytes block(1000);
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(read_count(port, 1000), Bytes(1000, 'U'));
        std::this_thread::sleep_for(milliseconds(5));
    }
    EXPECT_EQ(live.counts().lost, 0u);
}

TEST(LiveBoard, EventsComeInTheirOrderAtTheFirstBoundary) {
    LiveBoard live({}, Pace::eager);
    load(live.board(), "LOOP: JMP LOOP");  // 10 T
    std::vector<std::pair<int, uint64_t>> seen;
    const auto note = [&seen](int name) {
        return [&seen, name](Board& board) { seen.emplace_back(name, board.state.cpu.t); };
    };
    live.at(30, note(3));
    live.at(11, note(1));
    live.at(30, note(4));
    live.at(21, note(2));
    std::promise<void> over;
    live.at(10'001, [&](Board& board) {
        seen.emplace_back(5, board.state.cpu.t);
        live.at(5, [&](Board& late) {  // over already
            seen.emplace_back(6, late.state.cpu.t);
            over.set_value();
        });
    });
    live.start();
    over.get_future().wait();
    live.stop();
    using Seen = std::vector<std::pair<int, uint64_t>>;
    EXPECT_EQ(seen, (Seen{{1, 20}, {2, 30}, {3, 30}, {4, 30}, {5, 10'010}, {6, 10'010}}));
}

TEST(LiveBoard, ResetAndPowerFailureAtATState) {
    LiveBoard live({}, Pace::eager);
    load(live.board(), kEcho);
    live.board().state.memory.bytes[0x8000] = 0;
    live.at(100'000, [](Board& board) { board.reset(); });
    live.at(200'000, [](Board& board) { board.power_cycle(); });
    live.start();
    SerialPort port(live.path());
    while (live.elapsed_t() < 210'000) std::this_thread::sleep_for(milliseconds(1));
    port.write(counting(7, 3), kSoon);
    EXPECT_EQ(read_count(port, 3), counting(8, 3));
    EXPECT_EQ(ask(live, [](Board& board) { return board.state.memory.bytes[0x8000]; }), 3);
    live.stop();
    EXPECT_EQ(live.board().state.reset_count, 1u) << "RESET pulses of the last power-on";
}

// Characters that had left the board before its supply failed have left it.
TEST(LiveBoard, APowerFailureLosesNothingThatWasSent) {
    LiveBoard live({}, Pace::eager);
    load(live.board(), kTalk);
    std::vector<uint64_t> sent;
    // The first 'U' begins within 1000 T and ends 1600 T later.
    live.at(3000, [](Board& board) { board.power_cycle(); });
    live.at(3001, [&](Board&) { sent.push_back(live.counts().sent); });
    live.start();
    while (live.elapsed_t() < 10'000) std::this_thread::sleep_for(milliseconds(1));
    live.stop();
    EXPECT_EQ(sent, std::vector<uint64_t>{1});
}

TEST(LiveBoard, AnErrorInAnEventReachesTheOwner) {
    LiveBoard live;
    load(live.board(), kEcho);
    live.at(1000, [](Board&) { throw std::out_of_range("of the event"); });
    live.start();
    while (live.running()) std::this_thread::sleep_for(milliseconds(1));
    EXPECT_THROW(live.stop(), std::out_of_range);
    EXPECT_NO_THROW(live.stop()) << "said once";
    EXPECT_GE(live.board().state.cpu.t, 1000u);
}

TEST(LiveBoard, ABoardThatStopsSaysWhereAndWhy) {
    BoardOptions options;
    options.stop_at_halt = true;
    LiveBoard live(options);
    load(live.board(), "NOP\n DI\n HLT");
    live.start();
    while (live.running()) std::this_thread::sleep_for(milliseconds(1));
    try {
        live.stop();
        FAIL() << "no error";
    } catch (const LiveBoardError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("halted with interrupts disabled"));
        EXPECT_THAT(error.what(), testing::HasSubstr("PC 0003H"));
    }
}

TEST(LiveBoard, IsTheOwnersOnlyWhileItStands) {
    LiveBoard live;
    load(live.board(), kEcho);
    live.start();
    EXPECT_THROW((void)live.board(), std::logic_error);
    EXPECT_THROW(live.start(), std::logic_error);
    live.stop();
    const uint64_t t = live.board().state.cpu.t;
    EXPECT_EQ(live.elapsed_t(), t);
    live.start();  // goes on
    while (live.elapsed_t() < t + 5000) std::this_thread::sleep_for(milliseconds(1));
    SerialPort port(live.path());
    port.write(Bytes{1}, kSoon);
    EXPECT_EQ(read_count(port, 1), Bytes{2});
}

}  // namespace
