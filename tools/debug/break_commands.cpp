// break_commands.cpp - commands that make and change breakpoints. See commands.hpp.
#include <array>

#include "tools/debug/console.hpp"

namespace debug_console {

using host_sim::StepRecord;

namespace {

constexpr int64_t kIdMax = 1'000'000;
constexpr int64_t kIgnoreMax = 1'000'000'000'000;

std::string state_text(const Breakpoint& breakpoint) {
    std::string text = fmt::format(", {} hit(s)", breakpoint.hits);
    if (breakpoint.temporary) text += ", temporary";
    if (!breakpoint.enabled) text += ", disabled";
    if (breakpoint.ignore != 0) text += fmt::format(", ignores {} more", breakpoint.ignore);
    return text;
}

void list(Console& console) {
    const auto& all = console.session.breakpoints.list();
    if (all.empty()) console.write("no breakpoints\n");
    for (const Breakpoint& breakpoint : all) {
        console.print("{}: {}{}\n", breakpoint.id, breakpoint.text(console.session.names),
                      state_text(breakpoint));
    }
}

StepRecord::Kind take_interrupt(Arguments& arguments) {
    struct Name {
        std::string_view name;
        StepRecord::Kind kind;
    };
    constexpr std::array kNames = {
        Name{"any", StepRecord::Kind::instruction}, Name{"trap", StepRecord::Kind::trap},
        Name{"rst75", StepRecord::Kind::rst75},     Name{"7.5", StepRecord::Kind::rst75},
        Name{"rst65", StepRecord::Kind::rst65},     Name{"6.5", StepRecord::Kind::rst65},
        Name{"rst55", StepRecord::Kind::rst55},     Name{"5.5", StepRecord::Kind::rst55},
    };
    const std::string word = arguments.word("INTERRUPT");
    for (const Name& entry : kNames) {
        if (same_word(entry.name, word)) return entry.kind;
    }
    throw DebugError(
        fmt::format("{}: no interrupt of this board; use trap, rst75, rst65, rst55 or any", word));
}

void take_place(Console& console, Arguments& arguments, Breakpoint& breakpoint) {
    if (arguments.take("port")) {
        breakpoint.kind = Breakpoint::Kind::port;
        breakpoint.first = breakpoint.last =
            static_cast<uint16_t>(console.take_value(arguments, "PORT", 0, 0xFF));
        if (arguments.take("in")) breakpoint.writes = false;
        if (breakpoint.writes && arguments.take("out")) breakpoint.reads = false;
    } else if (arguments.take("interrupt")) {
        breakpoint.kind = Breakpoint::Kind::interrupt;
        breakpoint.interrupt = take_interrupt(arguments);
    } else if (const bool read = arguments.take("read"), write = !read && arguments.take("write");
               read || write || arguments.take("access")) {
        breakpoint.kind = Breakpoint::Kind::memory;
        breakpoint.reads = !write;
        breakpoint.writes = !read;
        const Console::Range range = console.take_range(arguments);
        breakpoint.first = range.first;
        breakpoint.last = range.last;
    } else {
        breakpoint.first = breakpoint.last = console.take_address(arguments);
    }
}

void make(Console& console, Arguments& arguments, bool temporary) {
    Breakpoint breakpoint;
    breakpoint.temporary = temporary;
    take_place(console, arguments, breakpoint);
    if (arguments.take("if")) {
        breakpoint.condition = Condition::parse(arguments.take_rest(), console.session.names);
    }
    arguments.expect_end();
    const unsigned id = console.session.breakpoints.add(breakpoint);
    console.print("breakpoint {}: {}\n", id, breakpoint.text(console.session.names));
}

void break_at(Console& console, Arguments& arguments) {
    if (arguments.empty()) return list(console);
    make(console, arguments, false);
}

void break_once(Console& console, Arguments& arguments) {
    make(console, arguments, true);
}

unsigned take_id(Console& console, Arguments& arguments) {
    return static_cast<unsigned>(console.take_value(arguments, "NUMBER", 1, kIdMax));
}

void remove(Console& console, Arguments& arguments) {
    if (arguments.take("all")) {
        arguments.expect_end();
        return console.session.breakpoints.clear();
    }
    do {
        console.session.breakpoints.remove(take_id(console, arguments));
    } while (!arguments.empty());
}

void set_enabled(Console& console, Arguments& arguments, bool enabled) {
    do {
        console.session.breakpoints.set_enabled(take_id(console, arguments), enabled);
    } while (!arguments.empty());
}

void enable(Console& console, Arguments& arguments) {
    set_enabled(console, arguments, true);
}

void disable(Console& console, Arguments& arguments) {
    set_enabled(console, arguments, false);
}

void ignore(Console& console, Arguments& arguments) {
    Breakpoint& breakpoint = console.session.breakpoints.at(take_id(console, arguments));
    const int64_t count = console.take_value(arguments, "COUNT", 0, kIgnoreMax);
    arguments.expect_end();
    breakpoint.ignore = static_cast<uint64_t>(count);
}

}  // namespace

std::vector<Command> break_commands() {
    return {
        {"break", "b", "break [PLACE [if CONDITION]]",
         "stop at an address, port, memory access or interrupt; or list all",
         "PLACE  ADDRESS                                   before the instruction there\n"
         "       port N [in|out]                           behind an IN or OUT\n"
         "       read|write|access ADDRESS[..ADDRESS]      behind an access to data\n"
         "       interrupt trap|rst75|rst65|rst55|any      when it is taken\n"
         "CONDITION compares values with == != < <= > >=, several joined by `and`.\n"
         "  break main\n  break read_adc+4 if A >= 80H and [mode] == 2\n"
         "  break port 08H out if A == 'K'\n  break write 8000H..80FFH\n"
         "  break interrupt rst75\n",
         break_at},
        {"tbreak", "tb", "tbreak PLACE [if CONDITION]", "the same, gone after the first stop",
         "  tbreak main\n  tbreak interrupt trap\n", break_once},
        {"delete", "del", "delete NUMBER...|all", "remove breakpoints",
         "  delete 2\n  delete 1 3\n  delete all\n", remove},
        {"enable", "", "enable NUMBER...", "let breakpoints stop again", "  enable 2\n", enable},
        {"disable", "", "disable NUMBER...", "keep breakpoints without stopping there",
         "  disable 2\n", disable},
        {"ignore", "", "ignore NUMBER COUNT", "let the next COUNT hits of a breakpoint pass",
         "  ignore 1 99\n", ignore},
    };
}

}  // namespace debug_console
