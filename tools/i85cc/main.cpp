// main.cpp - i85cc: C and C++20 to a program for the 8085.
// Exit codes   0 all is written, 1 not (messages on standard error)
// Guide        docs/guides/compiling.md
#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "toolchain/driver/outputs.hpp"
#include "toolchain/driver/report.hpp"
#include "toolchain/driver/work_folder.hpp"
#include "tools/i85cc/options.hpp"

namespace {

namespace driver = toolchain::driver;

/// Text for standard output: whoever reads it has to get all of it.
void print_text(const std::string& text) {
    const bool whole = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
    if (!whole || std::fflush(stdout) != 0) {
        throw driver::Failed("standard output: cannot be written: check who reads it");
    }
}

void run(const i85cc::Options& options) {
    if (options.help) return print_text(i85cc::help_text());
    if (options.version) return print_text("i85cc " ROVER_VERSION "\n");
    if (options.emit) {
        const std::string text = driver::compile_to_text(options.request, *options.emit);
        if (options.output.empty()) return print_text(text);
        return driver::write_all({{options.output, text}});
    }
    const driver::Result result = driver::compile_program(options.request);
    driver::write_all(driver::output_files(result.program, options.output));
    if (options.report) print_text(driver::report_text(result));
    if (options.times) print_text(driver::times_text(result));
}

/// Lets Ctrl-C and the like remove temporary files before they end the program.
void watch_signals() {
    sigset_t watched;
    sigemptyset(&watched);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&watched, signal);
    pthread_sigmask(SIG_BLOCK, &watched, nullptr);
    std::thread([watched] {
        int signal = 0;
        sigwait(&watched, &signal);
        driver::WorkFolder::remove_all();
        pthread_sigmask(SIG_UNBLOCK, &watched, nullptr);
        raise(signal);
    }).detach();
}

}  // namespace

int main(int argc, char** argv) {
    watch_signals();
    try {
        run(i85cc::parse_options({argv + 1, argv + argc}));
        return 0;
    } catch (const i85cc::UsageError& error) {
        fmt::print(stderr, "i85cc: {}\n", error.what());
    } catch (const driver::Failed& error) {
        fmt::print(stderr, "i85cc: {}\n", error.what());
    } catch (const std::exception& error) {
        fmt::print(stderr, "i85cc: internal error: {}: please report it with the source\n",
                   error.what());
    }
    return 1;
}
