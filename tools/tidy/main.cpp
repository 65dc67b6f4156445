// main.cpp - tidy: checks the tracked files of a repository against rules.toml.
// Usage        tidy [ROOT]      one line per violation, `file:line: rule: message`
// Exit codes   0 clean, 1 violations, 2 usage or a bad rule table
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>

#include "tools/tidy/tree_checks.hpp"

namespace {

namespace fs = std::filesystem;

std::string read_file(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::string quoted_for_shell(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

/// Paths that git tracks, relative to the root; empty when git cannot tell.
std::vector<std::string> tracked_paths(const fs::path& root) {
    const std::string command =
        "git -C " + quoted_for_shell(root.string()) + " ls-files -z 2>/dev/null";
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
    std::string output;
    if (pipe) {
        std::array<char, 4096> buffer{};
        std::size_t size = 0;
        while ((size = fread(buffer.data(), 1, buffer.size(), pipe.get())) > 0) {
            output.append(buffer.data(), size);
        }
    }
    std::vector<std::string> paths;
    for (std::size_t start = 0; start < output.size();) {
        const std::size_t end = output.find('\0', start);
        paths.push_back(output.substr(start, end - start));
        start = end + 1;
    }
    return paths;
}

/// Every file below the root but build products and hidden folders: a source archive has no git.
std::vector<std::string> walked_paths(const fs::path& root) {
    std::vector<std::string> paths;
    for (fs::recursive_directory_iterator at(root), end; at != end; ++at) {
        const std::string name = at->path().filename().string();
        if (at->is_directory()) {
            const bool top = at.depth() == 0;
            const bool product = top && (name == "build" || name == "out");
            if (product || name == ".git") at.disable_recursion_pending();
        } else if (at->is_regular_file()) {
            paths.push_back(fs::relative(at->path(), root).generic_string());
        }
    }
    return paths;
}

std::vector<tidy::SourceFile> read_tree(const fs::path& root) {
    std::vector<std::string> paths = tracked_paths(root);
    if (paths.empty()) paths = walked_paths(root);
    std::sort(paths.begin(), paths.end());
    std::vector<tidy::SourceFile> files;
    for (const std::string& path : paths) {
        if (!fs::is_regular_file(root / path)) continue;  // deleted but not committed, or a link
        std::string text = read_file(root / path);
        if (text.find('\0') != std::string::npos) text.clear();  // not text: only its path counts
        files.push_back({path, std::move(text)});
    }
    return files;
}

int check(const fs::path& root) {
    const fs::path table = root / "tools/tidy/rules.toml";
    if (!fs::is_regular_file(table)) {
        std::cerr << "tidy: " << table.string() << " is missing; give the repository's root\n";
        return 2;
    }
    tidy::Rules rules;
    try {
        rules = tidy::parse_rules(read_file(table));
    } catch (const tidy::RuleError& error) {
        std::cerr << "tidy: " << table.string() << ": " << error.what() << '\n';
        return 2;
    }
    const std::vector<tidy::SourceFile> files = read_tree(root);
    const std::vector<tidy::Violation> found = tidy::check_tree(files, rules);
    for (const tidy::Violation& violation : found) {
        std::cout << violation.file << ':' << violation.line << ": " << violation.rule << ": "
                  << violation.message << '\n';
    }
    std::cout << "tidy: " << files.size() << " files, " << found.size() << " violations\n";
    return found.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc > 2) {
        std::cerr << "usage: tidy [ROOT]\n";
        return 2;
    }
    return check(argc == 2 ? argv[1] : ".");
}
