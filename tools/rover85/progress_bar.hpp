// progress_bar.hpp - one line of progress on standard error, on terminals only.
#pragma once

#include <string>

class ProgressBar {
public:
    explicit ProgressBar(std::string label);
    ~ProgressBar();  ///< clears the line
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// @param share  [0, 1]
    void update(double share);

private:
    std::string label_;
    bool terminal_;
    int drawn_percent_ = -1;
};
