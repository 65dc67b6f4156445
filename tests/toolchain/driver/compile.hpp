// compile.hpp - requests for tests: sources given as text, messages kept.
#pragma once

#include <string>
#include <utility>

#include "toolchain/driver/driver.hpp"

namespace driver_test {

/// A request for one source of that text. Its name tells the language.
inline toolchain::driver::Request request_for(
    std::string text, std::string name = "test.cpp",
    toolchain::ir::Optimisation level = toolchain::ir::Optimisation::size) {
    toolchain::driver::Request request;
    request.sources.push_back({std::move(name), std::move(text)});
    request.level = level;
    request.messages = [](std::string_view) {};
    return request;
}

/// What compiling says that fails, or empty.
template <class Step>
std::string failure_of(Step step) {
    try {
        step();
    } catch (const toolchain::driver::Failed& failed) {
        return failed.what();
    }
    return {};
}

}  // namespace driver_test
