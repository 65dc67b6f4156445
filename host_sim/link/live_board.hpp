// live_board.hpp - a simulated board that lives: it runs in a thread of its own, and its serial
// link is a pseudo-terminal which others open like the port of a real board.
// Depends on   host_sim/board, pseudo_terminal.hpp.
// Exact        what the board does follows from its state, the characters and their T-states, and
//              the events. Only when a character arrives depends on the PC.
// Design note  docs/design/live-board.md
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <span>
#include <stdexcept>
#include <thread>

#include "host_sim/board/board.hpp"
#include "host_sim/link/pseudo_terminal.hpp"

namespace host_sim {

/// How the board's time follows that of the PC.
enum class Pace : uint8_t {
    real_time,  ///< 3,072,000 T a second; where the PC cannot keep up, time is lost
    /// As fast as it can while characters are under way or have just been, and somebody reads them;
    /// else real time, so that a program that answers within a second is not too late.
    eager,
};

/// The board did something that its options end a run for.
class LiveBoardError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

class LiveBoard {
public:
    /// Looks at the link and at the clock so often, in T-states: 1 ms.
    static constexpr uint64_t kSliceT = 3072;
    /// The link counts as silent when nothing was sent or received for so long, 20 ms: longer than
    /// the EEPROM takes to program a page.
    static constexpr uint64_t kSilentT = 20 * kSliceT;

    /// @errors  std::system_error: no pseudo-terminal
    explicit LiveBoard(const BoardOptions& options = {}, Pace pace = Pace::real_time);
    ~LiveBoard();  ///< stops it; an error of its thread is lost, so call stop()
    LiveBoard(const LiveBoard&) = delete;
    LiveBoard& operator=(const LiveBoard&) = delete;

    /// What others open as their serial port. It exists as long as this object.
    [[nodiscard]] const std::filesystem::path& path() const { return line_.path(); }

    /// The board itself. @errors  std::logic_error while it runs
    [[nodiscard]] Board& board();

    /// What is done with the board, in its thread, between two instructions.
    using Event = std::function<void(Board&)>;
    /// Queues an event: at the first instruction boundary at or after `t`, at once when that is
    /// over; several of one T-state in the order in which they were queued. Any thread may call it,
    /// an event too: one that queues itself anew feeds the board's inputs step by step. An event
    /// does what it likes but for putting the board's time back. What it throws ends the run.
    void at(uint64_t t, Event event);

    /// Goes on from where the board stands. @pre  it does not run
    void start();
    /// Ends the run; does nothing when it has ended.
    /// @errors  what ended the thread: of an event, or LiveBoardError
    void stop();
    /// False before start(), and as soon as stop() or an error has ended the thread.
    [[nodiscard]] bool running() const { return running_; }
    /// T-states since power-up, at most one slice behind.
    [[nodiscard]] uint64_t elapsed_t() const { return elapsed_t_; }

    /// Characters on the link so far.
    struct Counts {
        uint64_t received = 0;  ///< by the board
        uint64_t sent = 0;      ///< by the board
        uint64_t lost = 0;      ///< of those sent: nobody read them
    };
    [[nodiscard]] Counts counts() const { return {received_, sent_, lost_}; }

private:
    using Clock = std::chrono::steady_clock;

    void run();
    void run_slice();
    void run_events();
    [[nodiscard]] uint64_t next_event_t() const;
    void receive();
    void transmit();
    void keep_pace(uint64_t slice_t);
    [[nodiscard]] bool hurries() const;

    const Pace pace_;
    Board board_;
    PseudoTerminal line_;

    mutable std::mutex mutex_;  ///< of events_
    std::multimap<uint64_t, Event> events_;

    std::thread thread_;
    std::exception_ptr error_;  ///< of the thread; read when it has ended
    std::atomic<bool> stopping_ = false;
    std::atomic<bool> running_ = false;
    std::atomic<uint64_t> elapsed_t_ = 0;
    std::atomic<uint64_t> received_ = 0, sent_ = 0, lost_ = 0;

    // Of the thread.
    uint64_t line_free_t_ = 0;  ///< end of the last character to the board
    uint64_t last_sent_t_ = 0;  ///< end of the last character from it
    Clock::time_point burst_begin_;
    uint64_t burst_ = 0;     ///< characters sent since then
    Clock::time_point due_;  ///< when the PC's clock reaches the board's
};

}  // namespace host_sim
