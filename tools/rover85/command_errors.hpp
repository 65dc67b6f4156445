// command_errors.hpp - runs a command's work and turns refused input into exit code 3.
#pragma once

#include <exception>
#include <iostream>

/// Exit codes of rover85.
enum ExitCode : int { kExitPass = 0, kExitDifference = 1, kExitUsage = 2, kExitBadInput = 3 };

/// @return  what `work` returns; kExitBadInput, with one line on standard error, when it throws
template <class Work>
int guarded(Work&& work) {
    try {
        return work();
    } catch (const std::exception& error) {
        std::cerr << "rover85: " << error.what() << "\n";
        return kExitBadInput;
    }
}
