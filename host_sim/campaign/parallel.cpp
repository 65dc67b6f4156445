#include "host_sim/campaign/parallel.hpp"

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace host_sim {

namespace {

/// What the threads share; every member is touched under the mutex only.
struct Shared {
    std::mutex mutex;
    std::size_t next = 0, done = 0;
    std::size_t failed_index = 0;
    std::exception_ptr failure;
};

}  // namespace

void parallel_for(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& body,
                  const Progress& progress) {
    if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
    Shared shared;
    const auto work = [&] {
        for (;;) {
            std::size_t index = 0;
            {
                const std::lock_guard lock(shared.mutex);
                if (shared.next >= count || shared.failure) return;
                index = shared.next++;
            }
            std::exception_ptr failure;
            try {
                body(index);
            } catch (...) {
                failure = std::current_exception();
            }
            const std::lock_guard lock(shared.mutex);
            if (failure && (!shared.failure || index < shared.failed_index)) {
                shared.failure = failure;
                shared.failed_index = index;
            }
            if (!failure && progress) progress(++shared.done, count);
        }
    };
    std::vector<std::jthread> others;
    const std::size_t wanted = std::min<std::size_t>(threads, std::max<std::size_t>(count, 1));
    for (std::size_t i = 1; i < wanted; ++i) others.emplace_back(work);
    work();
    others.clear();  // joins
    if (shared.failure) std::rethrow_exception(shared.failure);
}

}  // namespace host_sim
