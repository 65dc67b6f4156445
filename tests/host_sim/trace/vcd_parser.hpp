// vcd_parser.hpp - a strict reader of Value Change Dumps, from the grammar of IEEE 1364-2005,
// clause 18.2, and nothing of the writer. Throws std::runtime_error on what the grammar or the
// declarations do not allow.
#pragma once

#include <cstdint>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace trace_test {

struct VcdChange {
    uint64_t time = 0;
    std::string value;  ///< "0", "x", "101"
    bool operator==(const VcdChange&) const = default;
};

struct VcdFile {
    std::string timescale;
    std::map<std::string, unsigned> widths;                 ///< by "scope.name"
    std::map<std::string, std::vector<VcdChange>> changes;  ///< by "scope.name", dump first
    uint64_t end = 0;                                       ///< last time mark
};

class VcdParser {
public:
    explicit VcdParser(const std::string& text) : in_(text) {
        if (text.empty() || text.back() != '\n') throw std::runtime_error("last line is cut off");
    }

    VcdFile parse() {
        declarations();
        simulation();
        return std::move(file_);
    }

private:
    std::string token() {
        std::string text;
        if (!(in_ >> text)) throw std::runtime_error("the file ends too early");
        return text;
    }
    void expect(const std::string& wanted) {
        const std::string found = token();
        if (found != wanted) throw std::runtime_error("'" + found + "' instead of " + wanted);
    }
    std::string text_to_end() {
        std::string all;
        for (std::string part = token(); part != "$end"; part = token()) {
            all += all.empty() ? part : " " + part;
        }
        return all;
    }

    void declarations() {
        std::vector<std::string> scope;
        for (;;) {
            const std::string keyword = token();
            if (keyword == "$enddefinitions") {
                expect("$end");
                if (!scope.empty()) throw std::runtime_error("a scope is open");
                if (file_.timescale.empty()) throw std::runtime_error("no timescale");
                return;
            }
            if (keyword == "$timescale") {
                file_.timescale = text_to_end();
            } else if (keyword == "$scope") {
                expect("module");
                scope.push_back(token());
                expect("$end");
            } else if (keyword == "$upscope") {
                if (scope.empty()) throw std::runtime_error("upscope without scope");
                scope.pop_back();
                expect("$end");
            } else if (keyword == "$var") {
                variable(scope);
            } else if (keyword == "$version" || keyword == "$date" || keyword == "$comment") {
                text_to_end();
            } else {
                throw std::runtime_error("declaration '" + keyword + "'");
            }
        }
    }

    void variable(const std::vector<std::string>& scope) {
        expect("wire");
        const auto width = static_cast<unsigned>(std::stoul(token()));
        const std::string code = token();
        for (const char letter : code) {
            if (letter < '!' || letter > '~') throw std::runtime_error("identifier code");
        }
        std::string name;
        for (const auto& part : scope) name += part + ".";
        name += token();
        expect("$end");
        if (!names_.emplace(code, name).second) throw std::runtime_error("identifier twice");
        if (!file_.widths.emplace(name, width).second) throw std::runtime_error("variable twice");
    }

    void simulation() {
        bool timed = false;
        bool dumped = false;
        std::string text;
        while (in_ >> text) {
            if (text[0] == '#') {
                const uint64_t time = std::stoull(text.substr(1));
                if (timed && time <= file_.end) throw std::runtime_error("time goes back");
                file_.end = time;
                timed = true;
            } else if (text == "$dumpvars") {
                if (dumped || !timed) throw std::runtime_error("$dumpvars");
                dumped = true;
                for (std::string value = token(); value != "$end"; value = token()) change(value);
                for (const auto& [name, width] : file_.widths) {
                    if (file_.changes[name].size() != 1) throw std::runtime_error("not dumped");
                }
            } else {
                if (!dumped) throw std::runtime_error("a change before $dumpvars");
                change(text);
            }
        }
    }

    void change(const std::string& text) {
        std::string value;
        std::string code;
        if (text[0] == 'b') {
            value = text.substr(1);
            code = token();
        } else {
            value = text.substr(0, 1);
            code = text.substr(1);
        }
        if (value.empty() || value.find_first_not_of("01xz") != std::string::npos) {
            throw std::runtime_error("value '" + text + "'");
        }
        const auto found = names_.find(code);
        if (found == names_.end()) throw std::runtime_error("code '" + code + "'");
        const unsigned width = file_.widths.at(found->second);
        if (value.size() > width || (text[0] == 'b') != (width > 1)) {
            throw std::runtime_error("value '" + text + "' for " + found->second);
        }
        file_.changes[found->second].push_back({file_.end, value});
    }

    std::istringstream in_;
    std::map<std::string, std::string> names_;  ///< by identifier code
    VcdFile file_;
};

}  // namespace trace_test
