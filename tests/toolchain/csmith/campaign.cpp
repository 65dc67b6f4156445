// campaign.cpp - see campaign.hpp.
#include "tests/toolchain/csmith/campaign.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <memory>
#include <new>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace csmith_test {

namespace {

/// The next seed, shared by all processes.
class SharedCounter {
public:
    explicit SharedCounter(uint64_t first) {
        void* memory = mmap(nullptr, sizeof(std::atomic<uint64_t>), PROT_READ | PROT_WRITE,
                            MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        if (memory == MAP_FAILED) throw std::runtime_error("mmap failed");
        next_ = new (memory) std::atomic<uint64_t>(first);
    }
    ~SharedCounter() { munmap(next_, sizeof *next_); }
    SharedCounter(const SharedCounter&) = delete;
    SharedCounter& operator=(const SharedCounter&) = delete;
    uint64_t take() { return (*next_)++; }

private:
    std::atomic<uint64_t>* next_ = nullptr;
};

/// Lines shorter than PIPE_BUF arrive whole, whoever else writes.
void send(int out, uint64_t seed, const Finding& finding) {
    const std::string line =
        fmt::format("{} {} {}\n", seed, static_cast<unsigned>(finding.verdict), finding.text);
    if (write(out, line.data(), line.size()) < 0) _exit(1);
}

[[noreturn]] void work_off(SharedCounter& next, uint64_t last, int out,
                           const std::function<Finding(uint64_t)>& work) {
    for (uint64_t seed = next.take(); seed <= last; seed = next.take()) {
        try {
            send(out, seed, work(seed));
        } catch (const std::exception& error) {
            send(out, seed, {Verdict::failed, error.what()});
        }
    }
    _exit(0);
}

void add(Summary& summary, uint64_t seed, const Finding& finding) {
    ++summary.counts.at(static_cast<std::size_t>(finding.verdict));
    if (finding.verdict != Verdict::agreed) summary.findings[seed] = finding;
}

}  // namespace

uint64_t Summary::done() const {
    return std::accumulate(counts.begin(), counts.end(), uint64_t{0});
}

bool Summary::has_fault() const {
    for (std::size_t i = 0; i < kVerdicts; ++i) {
        if (counts[i] != 0 && is_fault(static_cast<Verdict>(i))) return true;
    }
    return false;
}

std::string counts_text(const Summary& summary) {
    std::string text = fmt::format("{} programs", summary.done());
    for (std::size_t i = 0; i < kVerdicts; ++i) {
        if (i > 1 && summary.counts[i] == 0) continue;
        text += fmt::format(", {} {}", summary.counts[i], name_of(static_cast<Verdict>(i)));
    }
    return text;
}

Summary run_campaign(const Campaign& campaign, const std::function<Finding(uint64_t)>& work,
                     const std::function<void(const Summary&, uint64_t, const Finding&)>& each) {
    SharedCounter next(campaign.first);
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe failed");
    std::vector<pid_t> workers;
    for (unsigned i = 0; i < campaign.jobs; ++i) {
        const pid_t id = fork();
        if (id < 0) throw std::runtime_error("fork failed");
        if (id == 0) {
            close(ends[0]);
            work_off(next, campaign.last, ends[1], work);
        }
        workers.push_back(id);
    }
    close(ends[1]);
    Summary summary;
    std::vector<bool> seen(campaign.last - campaign.first + 1);
    const auto heard = [&](uint64_t seed, const Finding& finding) {
        seen.at(seed - campaign.first) = true;
        add(summary, seed, finding);
        if (each) each(summary, seed, finding);
    };
    const std::unique_ptr<FILE, int (*)(FILE*)> lines(fdopen(ends[0], "r"), fclose);
    std::array<char, 4096> line{};
    while (fgets(line.data(), line.size(), lines.get()) != nullptr) {
        unsigned long long seed = 0;
        unsigned verdict = 0;
        int text = 0;
        if (std::sscanf(line.data(), "%llu %u %n", &seed, &verdict, &text) < 2) continue;
        std::string rest = line.data() + text;
        while (!rest.empty() && rest.back() == '\n') rest.pop_back();
        heard(seed, {static_cast<Verdict>(verdict), rest});
    }
    for (const pid_t id : workers) waitpid(id, nullptr, 0);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (!seen[i]) heard(campaign.first + i, {Verdict::failed, "the comparing process died"});
    }
    return summary;
}

}  // namespace csmith_test
