// kernel_page.cpp - see kernel_page.hpp.
#include "tests/bench/kernel_page.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace bench {

namespace {

struct Page {
    std::string text;
    std::size_t first = 0;  ///< behind the first mark
    std::size_t last = 0;   ///< of the second one
};

constexpr const char* kEnd = "<!-- end -->\n";

Page load(const std::string& file, const std::string& name) {
    const std::string mark = "<!-- " + name + " -->\n";
    std::ifstream stream(file);
    std::ostringstream content;
    content << stream.rdbuf();
    Page page{.text = content.str()};
    const std::size_t begin = page.text.find(mark);
    const std::size_t end = begin == std::string::npos ? begin : page.text.find(kEnd, begin);
    if (!stream || end == std::string::npos) {
        throw std::runtime_error(file + " has no place for the tables of " + name);
    }
    page.first = begin + mark.size();
    page.last = end;
    return page;
}

}  // namespace

std::string read_page(const std::string& file, const std::string& name) {
    const Page page = load(file, name);
    return page.text.substr(page.first, page.last - page.first);
}

void write_page(const std::string& file, const std::string& name, const std::string& tables) {
    Page page = load(file, name);
    page.text.replace(page.first, page.last - page.first, tables);
    std::ofstream stream(file);
    stream << page.text;
    if (!stream.flush()) throw std::runtime_error(file + " cannot be written");
}

}  // namespace bench
