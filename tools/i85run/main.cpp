// main.cpp - i85run: runs an 8085 program to its end and counts its T-states.
// Exit codes   0 ran to HLT or return, 1 did not finish, 2 usage, 3 bad input (one line on standard
//              error).
// Guide        docs/guides/running-programs.md
#include <fmt/format.h>

#include <exception>
#include <variant>

#include "tools/i85run/options.hpp"
#include "tools/i85run/program.hpp"
#include "tools/i85run/session.hpp"

int main(int argc, char** argv) {
    const auto parsed = i85run::parse_options(argc, argv);
    if (const int* exit_code = std::get_if<int>(&parsed)) return *exit_code;
    try {
        return i85run::run_session(std::get<i85run::Options>(parsed));
    } catch (const i85run::UsageError& error) {
        fmt::print(stderr, "i85run: {}\n", error.what());
        return i85run::kExitUsage;
    } catch (const std::exception& error) {
        fmt::print(stderr, "i85run: {}\n", error.what());
        return i85run::kExitBadInput;
    }
}
