// tree_checks.cpp - the rules that look at all files together.
#include "tools/tidy/tree_checks.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include "tools/tidy/code_text.hpp"
#include "tools/tidy/file_checks.hpp"
#include "tools/tidy/markdown.hpp"

namespace tidy {
namespace {

namespace fs = std::filesystem;

using PathSet = std::set<std::string>;

PathSet paths_of(const std::vector<SourceFile>& files) {
    PathSet paths;
    for (const SourceFile& file : files) paths.insert(file.path);
    return paths;
}

std::string joined(const fs::path& folder, const std::string& name) {
    return (folder / name).lexically_normal().generic_string();
}

struct Include {
    int line = 0;
    std::string written;
    std::string file;  ///< empty: no tracked file of that name
};

std::string resolve(const std::string& written, const SourceFile& from, const PathSet& paths,
                    const Rules& rules) {
    const std::string beside = joined(fs::path(from.path).parent_path(), written);
    if (paths.contains(beside)) return beside;
    for (const std::string& directory : rules.include_directories) {
        const std::string candidate = joined(directory, written);
        if (paths.contains(candidate)) return candidate;
    }
    return {};
}

std::vector<Include> includes_of(const SourceFile& file, const PathSet& paths, const Rules& rules) {
    static const std::regex kInclude(R"re(^\s*#\s*include\s*"([^"]+)")re");
    std::vector<Include> includes;
    int number = 0;
    for (const std::string& line : split_lines(blank_comments_and_literals(file.text))) {
        ++number;
        std::smatch match;
        if (!std::regex_search(line, match, kInclude)) continue;
        const auto& generated = rules.generated_includes;
        if (std::find(generated.begin(), generated.end(), match[1].str()) != generated.end()) {
            continue;
        }
        includes.push_back({number, match[1].str(), resolve(match[1].str(), file, paths, rules)});
    }
    return includes;
}

bool is_cpp(const SourceFile& file) {
    return file.path.ends_with(".hpp") || file.path.ends_with(".cpp");
}

/// Depth-first search for cycles in the graph of includes.
class CycleSearch {
public:
    explicit CycleSearch(const std::map<std::string, std::vector<Include>>& graph)
        : graph_(graph) {}

    std::vector<Violation> run() {
        for (const auto& [file, includes] : graph_) visit(file);
        return std::move(found_);
    }

private:
    void visit(const std::string& file) {
        if (done_.contains(file)) return;
        const auto node = graph_.find(file);
        if (node == graph_.end()) return;
        path_.push_back(file);
        for (const Include& include : node->second) {
            const auto open = std::find(path_.begin(), path_.end(), include.file);
            if (open == path_.end()) {
                visit(include.file);
                continue;
            }
            std::string cycle;
            for (auto at = open; at != path_.end(); ++at) cycle += *at + " -> ";
            found_.push_back(
                {file, include.line, "include-cycle", "cycle: " + cycle + include.file});
        }
        path_.pop_back();
        done_.insert(file);
    }

    const std::map<std::string, std::vector<Include>>& graph_;
    std::vector<std::string> path_;
    PathSet done_;
    std::vector<Violation> found_;
};

/// Where a link of `page` leads: a path in the tree, without the anchor.
std::string link_path(const SourceFile& page, const std::string& target) {
    const std::string path = target.substr(0, target.find('#'));
    if (path.empty()) return page.path;
    std::string result = joined(fs::path(page.path).parent_path(), path);
    while (result.ends_with('/')) result.pop_back();
    return result;
}

/// Resolves links and commands of pages against the tree.
class PageChecker {
public:
    explicit PageChecker(const std::vector<SourceFile>& files) {
        static const std::regex kTarget(R"(\badd_executable\(\s*([\w-]+))");
        for (const SourceFile& file : files) {
            texts_[file.path] = &file.text;
            for (fs::path folder = fs::path(file.path).parent_path(); !folder.empty();
                 folder = folder.parent_path()) {
                folders_.insert(folder.generic_string());
            }
            if (!file.path.ends_with("CMakeLists.txt")) continue;
            std::sregex_iterator target(file.text.begin(), file.text.end(), kTarget);
            for (; target != std::sregex_iterator(); ++target) {
                programs_.insert("build/bin/" + (*target)[1].str());
            }
        }
    }

    void check(const SourceFile& page, std::vector<Violation>& found) const {
        static const std::regex kScheme(R"(^[a-z]+:)");
        for (const PageItem& link : link_targets(page.text)) {
            if (std::regex_search(link.text, kScheme)) continue;
            const std::string problem = problem_with_link(page, link.text);
            if (!problem.empty()) found.push_back({page.path, link.line, "page-link", problem});
        }
        for (const PageItem& program : command_programs(page.text)) {
            if (program_exists(program.text)) continue;
            found.push_back({page.path, program.line, "page-command",
                             "'" + program.text + "' is neither a tracked script nor a target"});
        }
    }

private:
    [[nodiscard]] std::string problem_with_link(const SourceFile& page,
                                                const std::string& target) const {
        const std::string path = link_path(page, target);
        const auto text = texts_.find(path);
        if (text == texts_.end()) {
            return folders_.contains(path) ? "" : "'" + target + "' leads to no tracked file";
        }
        const std::size_t hash = target.find('#');
        if (hash == std::string::npos || !path.ends_with(".md")) return "";
        const std::vector<std::string> anchors = heading_anchors(*text->second);
        const bool known =
            std::find(anchors.begin(), anchors.end(), target.substr(hash + 1)) != anchors.end();
        return known ? "" : "'" + target + "': no such heading";
    }

    [[nodiscard]] bool program_exists(const std::string& program) const {
        const std::string path = fs::path(program).lexically_normal().generic_string();
        return texts_.contains(path) || programs_.contains(path);
    }

    std::map<std::string, const std::string*> texts_;
    PathSet folders_;
    PathSet programs_;
};

}  // namespace

std::vector<Violation> check_includes(const std::vector<SourceFile>& files, const Rules& rules) {
    const PathSet paths = paths_of(files);
    std::map<std::string, std::vector<Include>> graph;
    std::vector<Violation> found;
    for (const SourceFile& file : files) {
        if (!is_cpp(file)) continue;
        const Layer* layer = longest_match(rules.layers, file.path);
        std::vector<Include>& includes = graph[file.path];
        includes = includes_of(file, paths, rules);
        for (const Include& include : includes) {
            if (include.file.empty()) {
                found.push_back({file.path, include.line, "include-path",
                                 "\"" + include.written + "\" is no tracked file"});
            } else if (layer != nullptr && !under_any(include.file, layer->may_include)) {
                found.push_back({file.path, include.line, "layer",
                                 layer->path + " may not include " + include.file});
            }
        }
    }
    const std::vector<Violation> cycles = CycleSearch(graph).run();
    found.insert(found.end(), cycles.begin(), cycles.end());
    return found;
}

std::vector<Violation> check_mirror(const std::vector<SourceFile>& files, const Rules& rules) {
    const PathSet paths = paths_of(files);
    PathSet included_by_mirror;
    for (const SourceFile& file : files) {
        if (!file.path.starts_with("tests/") || !is_cpp(file)) continue;
        const fs::path folder = fs::path(file.path.substr(6)).parent_path();
        for (const Include& include : includes_of(file, paths, rules)) {
            if (fs::path(include.file).parent_path() == folder) {
                included_by_mirror.insert(include.file);
            }
        }
    }
    std::vector<Violation> found;
    for (const SourceFile& file : files) {
        if (!file.path.ends_with(".hpp") || !under_any(file.path, rules.mirror_paths)) continue;
        if (included_by_mirror.contains(file.path)) continue;
        const CodeStructure code = scan_structure(blank_comments_and_literals(file.text));
        if (code.functions.empty() && !code.declares_functions) continue;
        const std::string folder = "tests/" + fs::path(file.path).parent_path().generic_string();
        found.push_back({file.path, 0, "mirror", "no test in " + folder + " includes it"});
    }
    return found;
}

std::vector<Violation> check_pages(const std::vector<SourceFile>& files) {
    const PageChecker checker(files);
    std::vector<Violation> found;
    for (const SourceFile& file : files) {
        if (file.path.ends_with(".md")) checker.check(file, found);
    }
    return found;
}

std::vector<Violation> check_tree(const std::vector<SourceFile>& files, const Rules& rules) {
    std::vector<Violation> found = check_includes(files, rules);
    const auto add = [&](const std::vector<Violation>& more) {
        found.insert(found.end(), more.begin(), more.end());
    };
    add(check_mirror(files, rules));
    add(check_pages(files));
    for (const SourceFile& file : files) add(check_file(file, rules));
    found = apply_exemptions(std::move(found), rules);
    std::stable_sort(found.begin(), found.end(), [](const Violation& a, const Violation& b) {
        return std::tie(a.file, a.line) < std::tie(b.file, b.line);
    });
    return found;
}

}  // namespace tidy
