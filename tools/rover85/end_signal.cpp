// end_signal.cpp - see end_signal.hpp.
#include "tools/rover85/end_signal.hpp"

#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>

namespace {

constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};

std::atomic<bool> signal_came = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may write it");
std::array<struct sigaction, kSignals.size()> before{};

}  // namespace

EndSignal::EndSignal() {
    signal_came = false;
    struct sigaction action = {};  // without SA_RESTART: what waits, ends its waiting
    action.sa_handler = [](int) { signal_came = true; };
    for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &before[i]);
}

EndSignal::~EndSignal() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before[i], nullptr);
}

bool EndSignal::came() const {
    return signal_came;
}
