// console.hpp - the debugger's command language on two streams.
// Depends on   session.hpp, commands.hpp.
// Use          one Console around one Session; execute() for single lines, run_script() for files,
//              interact() for a person or a pipe.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/debug/arguments.hpp"
#include "tools/debug/commands.hpp"
#include "tools/debug/debug_error.hpp"
#include "tools/debug/observers.hpp"
#include "tools/debug/serial_display.hpp"
#include "tools/debug/session.hpp"

namespace debug_console {

/// The board's state with what the console knew about its stack.
struct Snapshot {
    host_sim::BoardState state;
    CallStack calls;
};

class Console {
public:
    Console(Session& controlled, std::ostream& stream);
    ~Console();
    Console(const Console&) = delete;
    Console& operator=(const Console&) = delete;

    /// Does one line. @errors DebugError without a place
    void execute(std::string_view line);
    /// Does line after line until the end, `quit` or the first error.
    /// @errors DebugError as "NAME:LINE: what"; also after an interrupted run
    void run_script(std::istream& script, const std::string& name);
    /// The same with a prompt; errors are printed and the next line is read. An empty line repeats
    /// the line before.
    void interact(std::istream& input);
    /// `quit` was given.
    [[nodiscard]] bool finished() const { return finished_; }

    // -- For the commands
    // --------------------------------------------------------------------------------------------
    template <class... Values>
    void print(fmt::format_string<Values...> format, Values&&... values) {
        write(fmt::format(format, std::forward<Values>(values)...));
    }
    void write(std::string_view text);
    void quit() { finished_ = true; }

    /// Takes an address: a word that is an expression.
    uint16_t take_address(Arguments& arguments, std::string_view meaning = "ADDRESS") const;
    /// Takes a value in [min, max].
    int64_t take_value(Arguments& arguments, std::string_view meaning, int64_t min,
                       int64_t max) const;
    /// Takes "ADDR" or "ADDR..ADDR", the second not below the first.
    struct Range {
        uint16_t first = 0, last = 0;
    };
    Range take_range(Arguments& arguments) const;
    /// One instruction of a listing; the marks are > for PC and * for a breakpoint.
    [[nodiscard]] std::string listing_line(uint16_t address, uint8_t& bytes) const;
    /// Runs and tells why it ended, where, and after how many T-states.
    template <class Run>
    void run_and_report(Run&& run) {
        const uint64_t t = session.board.state.cpu.t, resets = session.board.state.reset_count;
        report(run(), t, resets);
    }

    /// @param from_t         when the command began
    /// @param resets_before  of the board then; more of them are told
    void report(const Stop& stop, uint64_t from_t, uint64_t resets_before);

    Session& session;
    SerialDisplay serial;
    Observers observers;
    std::map<std::string, Snapshot> snapshots;
    std::string newest_snapshot;
    std::optional<uint64_t> stimulus_t;  ///< inside `at`: when the stimulus shall act
    uint16_t next_dump = 0;              ///< where `memory` goes on
    std::optional<uint16_t> next_listing;

    [[nodiscard]] const std::vector<Command>& commands() const { return commands_; }
    /// By name, alias or the beginning of a name that begins only one.
    /// @errors DebugError when there is none or more than one
    [[nodiscard]] const Command& find_command(std::string_view word) const;
    /// Runs a command found by find_command.
    void dispatch(const Command& command, Arguments& arguments);
    /// Scripts inside scripts. @errors DebugError
    void source(const std::string& file);

private:
    std::ostream& out_;
    std::vector<Command> commands_;
    bool finished_ = false;
    bool interrupted_ = false;  ///< the last run was
    unsigned depth_ = 0;        ///< of scripts
};

}  // namespace debug_console
