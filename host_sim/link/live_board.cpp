// live_board.cpp - see live_board.hpp.
#include "host_sim/link/live_board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "hal/board/rb85.hpp"

namespace host_sim {

namespace rb85 = hal::rb85;

namespace {

constexpr uint64_t kCharacterT = 1600;  // 10 bits of 160 T
/// So many characters are taken from the pseudo-terminal ahead of their time. The others wait
/// there, and hold up their sender as a real port would.
constexpr uint64_t kAheadMax = 64;
/// With more than this unread, the board waits for its reader instead of hurrying on.
constexpr std::size_t kUnreadWhileHurrying = 256;
/// It sends at most so many characters in so long, 50 times as fast as the line: the system passes
/// them on to the reader's side a moment later, and until then they do not count as unread.
constexpr uint64_t kBurstMax = 512;
constexpr std::chrono::milliseconds kBurst{5};
/// A PC that is so late has lost the time: the board does not run to catch up.
constexpr std::chrono::milliseconds kLagMax{100};

std::chrono::nanoseconds wall_time(uint64_t t) {
    return std::chrono::nanoseconds(t * 1'000'000'000 / rb85::kClockHz);
}

std::string_view name_of(RunEnd end) {
    if (end == RunEnd::halted) return "halted with interrupts disabled";
    if (end == RunEnd::violation) return "did what working software does not do (a violation)";
    return "met an instruction that it does not have";
}

}  // namespace

LiveBoard::LiveBoard(const BoardOptions& options, Pace pace) : pace_(pace), board_(options) {}

LiveBoard::~LiveBoard() {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
}

Board& LiveBoard::board() {
    if (thread_.joinable()) throw std::logic_error("the live board runs; stop() it first");
    return board_;
}

void LiveBoard::at(uint64_t t, Event event) {
    const std::lock_guard lock(mutex_);
    events_.emplace(t, std::move(event));
}

void LiveBoard::start() {
    if (thread_.joinable()) throw std::logic_error("the live board runs already");
    stopping_ = false;
    running_ = true;
    error_ = nullptr;
    due_ = Clock::now();
    line_free_t_ = last_sent_t_ = elapsed_t_ = board_.state.cpu.t;
    thread_ = std::thread([this] {
        try {
            run();
        } catch (...) {
            error_ = std::current_exception();
        }
        running_ = false;
    });
}

void LiveBoard::stop() {
    if (!thread_.joinable()) return;
    stopping_ = true;
    thread_.join();
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

// -- The thread
// ----------------------------------------------------------------------------------

void LiveBoard::run() {
    while (!stopping_) {
        run_events();
        const uint64_t begin_t = board_.state.cpu.t;
        receive();
        run_slice();
        transmit();
        elapsed_t_ = board_.state.cpu.t;
        keep_pace(board_.state.cpu.t - begin_t);
    }
}

/// To the end of a slice or to the next event, whichever comes first.
void LiveBoard::run_slice() {
    const uint64_t until_t = std::min(board_.state.cpu.t + kSliceT, next_event_t());
    const RunEnd end = board_.run(until_t);
    if (end != RunEnd::time_limit) {
        throw LiveBoardError(
            fmt::format("the board {}, {:.4f} s after power-up, PC {:04X}H; look "
                        "at it with `rover85 debug`",
                        name_of(end), static_cast<double>(board_.state.cpu.t) / rb85::kClockHz,
                        board_.state.cpu.pc));
    }
}

void LiveBoard::run_events() {
    while (next_event_t() <= board_.state.cpu.t) {
        std::unique_lock lock(mutex_);
        const Event event = std::move(events_.extract(events_.begin()).mapped());
        lock.unlock();
        event(board_);
    }
}

uint64_t LiveBoard::next_event_t() const {
    const std::lock_guard lock(mutex_);
    return events_.empty() ? chips::kNever : events_.begin()->first;
}

// -- The link
// ------------------------------------------------------------------------------------

/// Each character has its own T-state, right behind the one before, so that slices do not show.
/// Queued as stimuli they are outside of the board: a power failure loses only those that come
/// while it is off.
void LiveBoard::receive() {
    const uint64_t now_t = board_.state.cpu.t;
    uint64_t begin_t = std::max(line_free_t_, now_t);
    const uint64_t ahead = (begin_t - now_t + kCharacterT - 1) / kCharacterT;
    if (ahead >= kAheadMax) return;
    for (const uint8_t byte : line_.read(kAheadMax - ahead)) {
        board_.schedule({begin_t, Stimulus::Kind::serial_byte, 0, byte});
        begin_t += kCharacterT;
        line_free_t_ = begin_t;
        ++received_;
    }
}

void LiveBoard::transmit() {
    const std::vector<chips::I8251a::TransmittedByte> sent = board_.take_transmitted();
    if (sent.empty()) return;
    std::vector<uint8_t> bytes;
    bytes.reserve(sent.size());
    for (const auto& character : sent) bytes.push_back(character.byte);
    last_sent_t_ = sent.back().end_t;
    sent_ += bytes.size();
    burst_ += bytes.size();
    lost_ += bytes.size() - line_.write(bytes);
}

// -- Time
// ----------------------------------------------------------------------------------------

/// Somebody waits for characters that are under way, or may have just got one.
bool LiveBoard::hurries() const {
    if (pace_ != Pace::eager || burst_ > kBurstMax) return false;
    if (line_.unread() > kUnreadWhileHurrying) return false;
    return std::max(line_free_t_, last_sent_t_) + kSilentT > board_.state.cpu.t;
}

void LiveBoard::keep_pace(uint64_t slice_t) {
    const Clock::time_point now = Clock::now();
    if (now - burst_begin_ >= kBurst) {
        burst_begin_ = now;
        burst_ = 0;
    }
    if (hurries()) {
        due_ = now;
        return;
    }
    due_ = std::max(due_ + wall_time(slice_t), now - kLagMax);
    const auto early = due_ - now;
    if (early <= std::chrono::nanoseconds(0)) return;
    const bool listens = pace_ == Pace::eager && line_free_t_ <= board_.state.cpu.t;
    if (!listens) {
        std::this_thread::sleep_for(early);
    } else if (line_.wait(early)) {
        due_ = Clock::now();
    }
}

}  // namespace host_sim
