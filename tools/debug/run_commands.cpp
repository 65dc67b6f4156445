// run_commands.cpp - commands that let the program run. See commands.hpp.
#include "tools/debug/console.hpp"
#include "tools/debug/registers.hpp"

namespace debug_console {
namespace {

constexpr int64_t kCountMax = 1'000'000'000'000;

void step(Console& console, Arguments& arguments) {
    uint64_t count = 1;
    if (!arguments.empty()) {
        count = static_cast<uint64_t>(console.take_value(arguments, "COUNT", 1, kCountMax));
    }
    arguments.expect_end();
    console.run_and_report([&] { return console.session.step(count); });
}

void over(Console& console, Arguments& arguments) {
    arguments.expect_end();
    console.run_and_report([&] { return console.session.over(); });
}

void finish(Console& console, Arguments& arguments) {
    arguments.expect_end();
    console.run_and_report([&] { return console.session.finish(); });
}

void until(Console& console, Arguments& arguments) {
    const uint64_t now_t = console.session.board.state.cpu.t;
    const uint64_t until_t = parse_time(arguments.word("TIME"), now_t);
    arguments.expect_end();
    if (until_t <= now_t) {
        throw DebugError(fmt::format("T {} is not ahead: it is T {} now; +TIME counts from here",
                                     until_t, now_t));
    }
    console.run_and_report([&] { return console.session.run(until_t); });
}

void go_on(Console& console, Arguments& arguments) {
    arguments.expect_end();
    console.run_and_report([&] { return console.session.run(); });
}

void go_to(Console& console, Arguments& arguments) {
    const uint16_t address = console.take_address(arguments);
    arguments.expect_end();
    set_register(console.session.board.state.cpu, Register::pc, address);
    uint8_t bytes = 0;
    console.print("{}\n", console.listing_line(address, bytes));
}

}  // namespace

std::vector<Command> run_commands() {
    return {
        {"step", "s", "step [COUNT]", "execute instructions, one or COUNT",
         "An interrupt that is taken, and a wait in HALT, count as steps of their own.\n"
         "  step\n  step 100\n",
         step},
        {"over", "o", "over", "execute one instruction; calls and interrupts as a whole",
         "Stops behind the CALL or RST at PC when it has returned; breakpoints on the way stop\n"
         "earlier.\n"
         "  over\n",
         over},
        {"finish", "fin", "finish", "run until the current function has returned",
         "By the stack pointer: exact for calls seen while stepping, otherwise the first return\n"
         "that leaves SP above where it is now.\n"
         "  finish\n",
         finish},
        {"until", "u", "until TIME", "run to a point in time",
         "TIME is in T-states or has a unit (us, ms, s at 3.072 MHz); + counts from now.\n"
         "Stops at the first instruction boundary there. For an address use `tbreak`.\n"
         "  until 100000\n  until +18\n  until +2.5ms\n",
         until},
        {"continue", "c", "continue", "run until a breakpoint, an error or Ctrl-C",
         "A breakpoint at PC itself is passed. `run` is the same.\n"
         "  continue\n",
         go_on},
        {"run", "", "run", "the same as continue", "  run\n", go_on},
        {"goto", "g", "goto ADDRESS", "set PC; executes nothing",
         "Also ends HALT.\n"
         "  goto main\n  goto $+3\n",
         go_to},
    };
}

}  // namespace debug_console
