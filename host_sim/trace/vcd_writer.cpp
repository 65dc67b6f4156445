// vcd_writer.cpp - see vcd_writer.hpp.
#include "host_sim/trace/vcd_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <iterator>
#include <numeric>
#include <span>

namespace host_sim {
namespace {

constexpr uint64_t kClockMaxHz = 1'000'000'000;

/// The open writers, as a list that a signal handler can walk.
std::atomic<VcdWriter*> open_writers = nullptr;

/// Holds SIGINT and SIGTERM off, so that a handler never sees a half-done change.
class SignalsHeld {
public:
    SignalsHeld() {
        sigset_t held;
        sigemptyset(&held);
        sigaddset(&held, SIGINT);
        sigaddset(&held, SIGTERM);
        pthread_sigmask(SIG_BLOCK, &held, &before_);
    }
    ~SignalsHeld() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    SignalsHeld(const SignalsHeld&) = delete;
    SignalsHeld& operator=(const SignalsHeld&) = delete;

private:
    sigset_t before_{};
};

/// Short name of a signal in the file: printable characters, ! to ~.
std::string identifier(std::size_t index) {
    constexpr std::size_t kLetters = '~' - '!' + 1;
    std::string text;
    do {
        text += static_cast<char>('!' + index % kLetters);
        index /= kLetters;
    } while (index != 0);
    return text;
}

void append_value(std::string& out, unsigned width, std::optional<uint64_t> value,
                  std::size_t index) {
    if (!value) {
        out += width == 1 ? "x" : "bx ";
    } else if (width == 1) {
        out += *value != 0 ? '1' : '0';
    } else {
        fmt::format_to(std::back_inserter(out), "b{:b} ", *value);
    }
    out += identifier(index);
    out += '\n';
}

bool is_name(std::string_view text) {
    return !text.empty() &&
           std::ranges::all_of(text, [](char letter) { return letter > ' ' && letter <= '~'; });
}

std::vector<std::string_view> split_scope(std::string_view scope) {
    std::vector<std::string_view> parts;
    while (!scope.empty()) {
        const std::size_t dot = std::min(scope.find('.'), scope.size());
        parts.push_back(scope.substr(0, dot));
        scope.remove_prefix(std::min(dot + 1, scope.size()));
    }
    return parts;
}

void on_signal(int signal) {
    flush_all_vcd();
    // SA_RESETHAND has put the default action back; it happens when this handler returns.
    ::raise(signal);
}

}  // namespace

void flush_all_vcd() noexcept {
    for (VcdWriter* writer = open_writers; writer != nullptr; writer = writer->next_) {
        writer->emergency_flush();
    }
}

void flush_vcd_on_signals() {
    struct sigaction action = {};
    action.sa_handler = on_signal;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigemptyset(&action.sa_mask);
    sigaddset(&action.sa_mask, SIGINT);
    sigaddset(&action.sa_mask, SIGTERM);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

VcdWriter::VcdWriter(const std::filesystem::path& path, uint64_t clock_hz)
    : path_(path), clock_hz_(clock_hz) {
    if (clock_hz == 0 || clock_hz > kClockMaxHz) {
        throw std::invalid_argument("the clock of a VCD file is 1 Hz to 1 GHz");
    }
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail("cannot be written", errno);
    const SignalsHeld held;
    next_ = open_writers.load();
    open_writers = this;
}

VcdWriter::~VcdWriter() {
    try {
        close();
    } catch (const VcdError&) {
        // close() is the way to hear of it.
    }
}

void VcdWriter::fail(std::string_view what, int error) const {
    throw VcdError(fmt::format("{}: {}: {}", path_.string(), what, std::strerror(error)));
}

VcdWriter::Signal VcdWriter::add_signal(std::string_view scope, std::string_view name,
                                        unsigned width, std::optional<uint64_t> initial) {
    if (begun_) throw std::logic_error("a VCD signal is added after the first change");
    const auto parts = split_scope(scope);
    if (!is_name(name) || !std::ranges::all_of(parts, is_name) || width < 1 || width > 64) {
        throw std::invalid_argument(
            fmt::format("VCD signal '{}.{}' of {} bits: a name has no spaces, a width is 1 to 64",
                        scope, name, width));
    }
    signals_.push_back({std::string(scope), std::string(name), width, {}});
    if (initial) signals_.back().value = *initial & ~uint64_t{0} >> (64 - width);
    return signals_.size() - 1;
}

/// The head is one record, so that a file never holds a part of it.
void VcdWriter::begin() {
    begun_ = true;
    record_ = "$version rover85 $end\n$timescale 1 ns $end\n";
    std::vector<std::size_t> order(signals_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {},
                             [this](std::size_t i) { return split_scope(signals_[i].scope); });
    std::vector<std::string_view> open;
    for (const std::size_t i : order) {
        const auto wanted = split_scope(signals_[i].scope);
        const auto common =
            static_cast<std::size_t>(std::ranges::mismatch(open, wanted).in1 - open.begin());
        for (; open.size() > common; open.pop_back()) record_ += "$upscope $end\n";
        while (open.size() < wanted.size()) {
            open.push_back(wanted[open.size()]);
            record_ += fmt::format("$scope module {} $end\n", open.back());
        }
        record_ += fmt::format("$var wire {} {} {} $end\n", signals_[i].width, identifier(i),
                               signals_[i].name);
    }
    for (; !open.empty(); open.pop_back()) record_ += "$upscope $end\n";
    record_ += "$enddefinitions $end\n#0\n$dumpvars\n";
    for (std::size_t i = 0; i < signals_.size(); ++i) {
        append_value(record_, signals_[i].width, signals_[i].value, i);
    }
    record_ += "$end\n";
    append(record_);
}

void VcdWriter::change(Signal signal, uint64_t value, uint64_t t) {
    if (descriptor_ < 0) throw std::logic_error("a VCD change after close()");
    if (t < last_t_) throw std::logic_error("a VCD change goes back in time");
    if (!begun_) begin();
    Line& line = signals_.at(signal);
    value &= ~uint64_t{0} >> (64 - line.width);
    last_t_ = t;
    if (line.value == value) return;
    line.value = value;
    record_.clear();
    stamp(t);
    append_value(record_, line.width, value, signal);
    append(record_);
}

/// Puts a time mark into the record, unless the file already is at that time.
void VcdWriter::stamp(uint64_t t) {
    const uint64_t ns = ns_from_t(t, clock_hz_);
    if (ns == last_ns_) return;
    last_ns_ = ns;
    fmt::format_to(std::back_inserter(record_), "#{}\n", ns);
}

/// Whole records only: what lies in front of complete_ can always be written as it is. A record
/// longer than the buffer (many signals) goes through it in pieces.
void VcdWriter::append(std::string_view record) {
    while (!record.empty()) {
        const std::size_t filled = complete_;
        if (record.size() > kBufferSize - filled && filled > 0) {
            flush();
            continue;
        }
        const std::size_t size = std::min(record.size(), kBufferSize - filled);
        std::memcpy(buffer_.data() + filled, record.data(), size);
        complete_ = filled + size;
        record.remove_prefix(size);
    }
}

void VcdWriter::write_pending(bool& failed, int& error) noexcept {
    while (written_ < complete_) {
        const ssize_t count = ::write(descriptor_, buffer_.data() + written_, complete_ - written_);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) {
            failed = true;
            error = errno;
            return;
        }
        written_ += static_cast<std::size_t>(count);
    }
}

void VcdWriter::emergency_flush() noexcept {
    const int saved = errno;
    bool failed = false;
    int error = 0;
    if (descriptor_ >= 0) write_pending(failed, error);
    errno = saved;
}

void VcdWriter::flush() {
    if (descriptor_ < 0) return;
    bool failed = false;
    int error = 0;
    {
        const SignalsHeld held;
        write_pending(failed, error);
        if (!failed) {
            written_ = 0;
            complete_ = 0;
        }
    }
    if (failed) fail("cannot be written", error);
}

void VcdWriter::close(std::optional<uint64_t> end_t) {
    if (descriptor_ < 0) return;
    if (end_t && *end_t < last_t_) throw std::logic_error("a VCD file ends before its last change");
    bool failed = false;
    int error = 0;
    try {
        if (!begun_) begin();
        record_.clear();
        if (end_t) stamp(*end_t);
        append(record_);
    } catch (const VcdError&) {
        failed = true;
        error = errno;
    }
    {
        const SignalsHeld held;
        if (!failed) write_pending(failed, error);
        std::atomic<VcdWriter*>* link = &open_writers;
        while (*link != this) link = &link->load()->next_;
        *link = next_.load();
        if (::close(descriptor_) != 0 && !failed) {
            failed = true;
            error = errno;
        }
        descriptor_ = -1;
    }
    if (failed) fail("cannot be written", error);
}

}  // namespace host_sim
