#include "tests/system/program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "firmware/link/telemetry.hpp"

namespace system_test {
namespace {

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

void redirect(const std::string& file, int descriptor) {
    const int opened = open(file.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
    if (opened < 0 || dup2(opened, descriptor) < 0) _exit(126);
}

std::string estimate_bytes(const rover::Estimates& estimates) {
    std::uint8_t frame[hal::kTelemetryBytesMax] = {};
    const std::uint8_t size = rover::write_telemetry(estimates, frame);
    return {reinterpret_cast<const char*>(frame), size};
}

std::string command_text(const hal::Commands& commands) {
    std::ostringstream text;
    for (const int percent : commands.drive_percent) text << percent << ' ';
    for (const int steer : commands.steer_brad) text << steer << ' ';
    text << commands.mast_brad << ' ' << int{commands.laser_bits} << ' ';
    text.write(reinterpret_cast<const char*>(commands.telemetry), commands.telemetry_size);
    return text.str();
}

std::string input_text(const hal::RawInputs& inputs) {
    std::ostringstream text;
    text << inputs.tick_count;
    for (const unsigned count : inputs.adc_q4_count) text << ' ' << count;
    for (const unsigned count : inputs.tach_count) text << ' ' << count;
    text << ' ' << int{inputs.tach_present} << ' ' << int{inputs.range_scan_count} << ' '
         << int{inputs.range_present};
    for (const int range : inputs.range_q1_mm) text << ' ' << range;
    text << ' ' << int{inputs.detector_bits} << ' ';
    text.write(reinterpret_cast<const char*>(inputs.command), inputs.command_size);
    return text.str();
}

template <class T, class ToText>
bool same(const std::optional<T>& a, const std::optional<T>& b, ToText to_text) {
    return a.has_value() == b.has_value() && (!a || to_text(*a) == to_text(*b));
}

}  // namespace

Process::Process(const std::vector<std::string>& arguments, const std::filesystem::path& cwd) {
    std::vector<std::string> words = {ROVER85_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    child_ = fork();
    if (child_ < 0) throw std::runtime_error("fork failed");
    if (child_ == 0) {
        redirect(folder_ / "out", STDOUT_FILENO);
        redirect(folder_ / "err", STDERR_FILENO);
        if (!cwd.empty() && chdir(cwd.c_str()) != 0) _exit(126);
        execv(ROVER85_PROGRAM, argv.data());
        _exit(127);
    }
}

Process::~Process() {
    if (child_ < 0) return;
    kill(child_, SIGKILL);
    (void)wait();
}

void Process::signal(int number) const {
    kill(child_, number);
}

std::string Process::out() const {
    const std::string file = folder_ / "out";
    return std::filesystem::exists(file) ? read_bytes(file) : "";
}

bool Process::says(const std::string& text) const {
    const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (out().find(text) == std::string::npos) {
        if (std::chrono::steady_clock::now() > limit) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
}

Outcome Process::wait() {
    int status = 0;
    rusage usage{};
    if (wait4(child_, &status, 0, &usage) != child_) throw std::runtime_error("wait4 failed");
    child_ = -1;
    Outcome run;
    if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
    run.out = read_bytes(folder_ / "out");
    run.err = read_bytes(folder_ / "err");
    run.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    return run;
}

Outcome rover85(const std::vector<std::string>& arguments, const std::filesystem::path& cwd) {
    return Process(arguments, cwd).wait();
}

Folder::Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "rover85_system_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed: " + name);
    path_ = name;
}

Folder::~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string read_bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw std::runtime_error("cannot read " + file.string());
    return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream out(file, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

std::string first_difference(const host_sim::Log& a, const host_sim::Log& b) {
    if (a.steps.size() != b.steps.size()) {
        return std::to_string(a.steps.size()) + " steps against " + std::to_string(b.steps.size());
    }
    for (std::size_t i = 0; i < a.steps.size(); ++i) {
        const host_sim::LogStep &x = a.steps[i], &y = b.steps[i];
        const std::string where = " differs in step " + std::to_string(i);
        if (x.time_ms != y.time_ms) return "time" + where;
        if (input_text(x.inputs) != input_text(y.inputs)) return "inputs" + where;
        if (!same(x.estimates, y.estimates, estimate_bytes)) return "estimates" + where;
        if (!same(x.commands, y.commands, command_text)) return "commands" + where;
    }
    return {};
}

std::filesystem::path study_data(const std::string& name) {
    return std::filesystem::path(ROVER_SOURCE_DIR) / "../shared/data" / name;
}

}  // namespace system_test
