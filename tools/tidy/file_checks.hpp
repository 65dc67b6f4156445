// file_checks.hpp - the rules that look at one file at a time.
#pragma once

#include <vector>

#include "tools/tidy/rules.hpp"

namespace tidy {

/// Header comment, #pragma once, sizes and forbidden words of one file. Files that are neither
/// C++ nor scripts get the checks of text only (patterns with `files = [""]`, final newline).
/// A comment `tidy-allow(rule): reason` on the line or the one above allows that rule there.
std::vector<Violation> check_file(const SourceFile& file, const Rules& rules);

}  // namespace tidy
