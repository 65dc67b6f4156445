#include "tools/rover85/recover_command.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "host_sim/log/log_io.hpp"
#include "tools/rover85/command_errors.hpp"

namespace {

struct RecoverOptions {
    std::string in, out;
};

int recover(const RecoverOptions& options) {
    const host_sim::Recovery recovery = host_sim::recover_rlog(options.in, options.out);
    fmt::print("{}: {} steps, {} bytes kept, {} bytes dropped\n", options.out, recovery.steps,
               recovery.kept_bytes, recovery.dropped_bytes);
    if (!recovery.reason.empty()) fmt::print("First dropped byte: {}\n", recovery.reason);
    return kExitPass;
}

}  // namespace

void add_recover_command(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<RecoverOptions>();
    CLI::App& command = *app.add_subcommand(
        "recover", "Salvage the whole records of a torn .rlog, and verify them");
    command.add_option("LOG", options->in, "Torn log")->required()->type_name("RLOG");
    command.add_option("-o,--output", options->out, "Log to write")->required()->type_name("OUT");
    command.footer("Example:\n  rover85 recover crashed.rlog -o whole.rlog");
    command.callback(
        [options, &exit_code] { exit_code = guarded([&] { return recover(*options); }); });
}
