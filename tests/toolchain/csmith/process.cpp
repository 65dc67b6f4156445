// process.cpp - see process.hpp.
#include "tests/toolchain/csmith/process.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <exception>
#include <stdexcept>

namespace csmith_test {

namespace {

void limit(unsigned seconds) {
    const rlimit time{seconds, seconds + 1};
    setrlimit(RLIMIT_CPU, &time);
    const rlimit no_dump{0, 0};
    setrlimit(RLIMIT_CORE, &no_dump);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
}

/// Runs `child` in a fork with the end of a pipe; reads the pipe to its end.
Ran run(const std::function<int(int)>& child, unsigned seconds) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe failed");
    const pid_t id = fork();
    if (id < 0) throw std::runtime_error("fork failed");
    if (id == 0) {
        close(ends[0]);
        limit(seconds);
        _exit(child(ends[1]));
    }
    close(ends[1]);
    Ran result;
    std::array<char, 4096> buffer{};
    ssize_t got = 0;
    while ((got = read(ends[0], buffer.data(), buffer.size())) > 0)
        result.text.append(buffer.data(), static_cast<std::size_t>(got));
    close(ends[0]);
    int status = 0;
    waitpid(id, &status, 0);
    if (WIFSIGNALED(status)) {
        result.status = WTERMSIG(status);
        const bool time = result.status == SIGXCPU || result.status == SIGKILL;
        result.end = time ? Ran::End::out_of_time : Ran::End::crashed;
    } else {
        result.status = WEXITSTATUS(status);
        result.end = result.status == 0 ? Ran::End::finished : Ran::End::failed;
    }
    return result;
}

}  // namespace

Ran run_program(const std::vector<std::string>& arguments, unsigned seconds,
                const std::filesystem::path& folder) {
    std::vector<std::string> words = arguments;
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return run(
        [&](int out) {
            if (chdir(folder.c_str()) != 0) return 126;
            dup2(out, STDOUT_FILENO);
            dup2(out, STDERR_FILENO);
            execvp(pointers[0], pointers.data());
            return 127;
        },
        seconds);
}

Ran run_apart(const std::function<void(const Say&)>& work, unsigned seconds) {
    return run(
        [&](int out) {
            const Say say = [out](const std::string& text) {
                std::size_t sent = 0;
                while (sent < text.size()) {
                    const ssize_t now = write(out, text.data() + sent, text.size() - sent);
                    if (now <= 0) _exit(2);
                    sent += static_cast<std::size_t>(now);
                }
            };
            try {
                work(say);
            } catch (const std::exception& error) {
                say(error.what());
                return 1;
            }
            return 0;
        },
        seconds);
}

WorkFolder::WorkFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "csmith_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed: " + name);
    path_ = name;
}

WorkFolder::~WorkFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace csmith_test
