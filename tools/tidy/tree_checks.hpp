// tree_checks.hpp - the rules that look at all files together.
#pragma once

#include <vector>

#include "tools/tidy/rules.hpp"

namespace tidy {

/// Includes follow the layers, name files that exist and form no cycle.
std::vector<Violation> check_includes(const std::vector<SourceFile>& files, const Rules& rules);

/// Every header that defines or declares a function is included by a test in the folder that
/// mirrors its own: host_sim/log/x.hpp by a file of tests/host_sim/log.
std::vector<Violation> check_mirror(const std::vector<SourceFile>& files, const Rules& rules);

/// Relative links of Markdown pages lead to tracked files, folders and headings; programs in their
/// command lines are tracked scripts or targets of a CMakeLists.txt.
std::vector<Violation> check_pages(const std::vector<SourceFile>& files);

/// All rules on all files, exemptions applied, in the order of files and lines.
std::vector<Violation> check_tree(const std::vector<SourceFile>& files, const Rules& rules);

}  // namespace tidy
