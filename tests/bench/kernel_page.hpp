// kernel_page.hpp - the page with the kernels' figures: tables between two marks.
// Depends on   the standard library.
#pragma once

#include <string>

namespace bench {

inline constexpr const char* kPageBegin = "<!-- kernel_benchmark -->\n";
inline constexpr const char* kPageEnd = "<!-- end -->\n";

/// What stands between the marks. @errors std::runtime_error: no file, no marks
[[nodiscard]] std::string read_page(const std::string& file);

/// Puts `tables` there. @errors as above
void write_page(const std::string& file, const std::string& tables);

}  // namespace bench
