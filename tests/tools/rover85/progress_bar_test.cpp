// progress_bar_test.cpp - drawn on a terminal, nothing anywhere else. Standard error is replaced by
// a pseudo-terminal or a pipe.
#include "tools/rover85/progress_bar.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <cstdio>

namespace {

/// Puts `writer` in the place of standard error while `work` runs; gives what arrived at `reader`.
template <class Work>
std::string caught(int reader, int writer, Work work) {
    std::fflush(stderr);
    const int saved = dup(STDERR_FILENO);
    dup2(writer, STDERR_FILENO);
    work();
    std::fflush(stderr);
    dup2(saved, STDERR_FILENO);
    close(saved);
    fcntl(reader, F_SETFL, O_NONBLOCK);
    std::string text;
    char bytes[4096];
    for (ssize_t size = 0; (size = read(reader, bytes, sizeof bytes)) > 0;) {
        text.append(bytes, static_cast<std::size_t>(size));  // a terminal gives it in pieces
    }
    return text;
}

void draw() {
    ProgressBar bar("Driving");
    for (const double share : {0.0, 0.5, 0.501, 0.502, 1.0}) bar.update(share);
}

TEST(ProgressBar, DrawsEachPercentOnceOnATerminalAndClearsTheLine) {
    const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
    ASSERT_GE(terminal, 0);
    ASSERT_EQ(grantpt(terminal) | unlockpt(terminal), 0);
    const int line = open(ptsname(terminal), O_RDWR | O_NOCTTY);
    ASSERT_GE(line, 0);
    const std::string text = caught(terminal, line, draw);
    EXPECT_EQ(text,
              "\rDriving [                              ]   0 %"
              "\rDriving [===============               ]  50 %"
              "\rDriving [==============================] 100 %"
              "\r\033[K");
    close(line);
    close(terminal);
}

TEST(ProgressBar, IsSilentInAPipe) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    EXPECT_EQ(caught(ends[0], ends[1], draw), "");
    close(ends[0]);
    close(ends[1]);
}

}  // namespace
