// names.cpp - see names.hpp.
#include "toolchain/codegen/names.hpp"

#include <cxxabi.h>
#include <fmt/format.h>

#include <cctype>
#include <cstdlib>
#include <memory>
#include <set>
#include <string_view>

namespace toolchain::codegen {

namespace {

bool is_plain(char letter) {
    constexpr std::string_view kOthers = "_.@?";
    return std::isalnum(static_cast<unsigned char>(letter)) != 0 ||
           kOthers.find(letter) != std::string_view::npos;
}

/// As the assembler takes it, but perhaps another symbol's name too.
std::string plain(const std::string& name) {
    std::string result = name;
    for (char& letter : result) {
        if (!is_plain(letter)) letter = '_';
    }
    const bool bad_start = result.empty() || result[0] == '.' || result[0] == '?' ||
                           std::isdigit(static_cast<unsigned char>(result[0])) != 0;
    return bad_start ? "_" + result : result;
}

}  // namespace

SafeNames::SafeNames(const Module& module) {
    std::set<std::string> taken;
    for (const std::string& name : module.symbols) {
        if (plain(name) == name) taken.insert(name);
    }
    for (const std::string& name : module.symbols) {
        std::string safe = plain(name);
        if (safe != name) {
            const std::string first = safe;
            for (int number = 2; !taken.insert(safe).second; ++number) {
                safe = fmt::format("{}@{}", first, number);
            }
        }
        names_.push_back(std::move(safe));
    }
}

std::string demangled(const std::string& name) {
    if (!name.starts_with("_Z")) return {};
    int status = 0;
    const std::unique_ptr<char, void (*)(void*)> text(
        abi::__cxa_demangle(name.c_str(), nullptr, nullptr, &status), std::free);
    return status == 0 ? std::string(text.get()) : std::string();
}

}  // namespace toolchain::codegen
