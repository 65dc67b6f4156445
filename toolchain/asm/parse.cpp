// parse.cpp - the lines into items; operands when all labels are known.
#include "toolchain/asm/parse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "toolchain/asm/expression.hpp"
#include "toolchain/asm/opcode_lookup.hpp"
#include "toolchain/asm/source_lines.hpp"

namespace toolchain::assembly {
namespace {

constexpr std::size_t kMemorySize = 0x10000;
constexpr std::string_view kStartLabel = ".start";  ///< made where $ has no label in front of it

/// An operand whose expression waits for the labels below it.
struct Pending {
    std::size_t section;
    std::size_t item;
    std::string expression;
    Base here;
};

struct LabelPlace {
    std::size_t section;
    int32_t offset;
};

SectionKind kind_of(std::string_view name) {
    for (const SectionKind kind :
         {SectionKind::code, SectionKind::constant, SectionKind::initialised, SectionKind::zero,
          SectionKind::persistent, SectionKind::frame}) {
        if (upper_case(kind_name(kind)) == upper_case(name)) return kind;
    }
    throw Mistake(fmt::format(
        "'{}' is no kind of section; code, constant, initialised, zero, persistent, frame are",
        name));
}

class Parser {
public:
    explicit Parser(const ParseOptions& options) : options_(options) {
        module_.name = options.file;
        module_.files = {options.file};
        names_.symbol = [this](const std::string& symbol) { return symbol_value(symbol); };
        names_.here = [this] { return here(); };
        names_.address = [this](int section) -> std::optional<int32_t> {
            return module_.sections[static_cast<std::size_t>(section)].address;
        };
    }

    Module run(std::string_view source) {
        open_section("code", SectionKind::code);
        module_.sections[0].address = options_.origin;
        bool more = true;
        while (more && !source.empty()) {
            const std::size_t end = std::min(source.find('\n'), source.size());
            ++line_number_;
            more = guarded([&] { return line(source.substr(0, end)); });
            source.remove_prefix(std::min(end + 1, source.size()));
        }
        above_only_ = false;
        for (const Pending& pending : pending_) {
            line_number_ = item_of(pending).location.line;
            guarded([&] {
                resolve(pending);
                return true;
            });
        }
        insert_start_labels();
        if (!mistakes_.empty()) throw Error(std::move(mistakes_));
        if (module_.sections[0].items.empty()) module_.sections.erase(module_.sections.begin());
        return std::move(module_);
    }

private:
    /// Runs a step on a line and collects its mistake. True if parsing goes on.
    template <typename Step>
    bool guarded(Step step) {
        try {
            return step();
        } catch (const Mistake& mistake) {
            mistakes_.push_back({options_.file, line_number_, mistake.what()});
            return true;
        }
    }

    bool line(std::string_view text) {
        if (options_.routine_comments && text.starts_with(";  ")) routine_comment(text);
        line_ = split_line(text);
        here_ = size_;
        if (line_.operation == "END") return false;
        if (!line_.label.empty() && line_.operation != "EQU") define_label(line_.label);
        if (!line_.note.empty()) add(note(line_.note, location()));
        if (line_.operation.empty() || directive()) return true;
        instruction_line();
        return true;
    }

    // -- Names -----------------------------------------------------------------------------------

    [[nodiscard]] Location location() const { return {0, line_number_}; }

    /// What a name is looked up by: a local one together with its section.
    [[nodiscard]] std::pair<std::size_t, std::string> key(const std::string& symbol) const {
        return {is_local(symbol) ? section_ + 1 : 0, symbol};
    }

    void define(const std::string& symbol) {
        if (!defined_.insert({key(symbol), line_number_}).second) {
            throw Mistake("'" + symbol + "' is defined twice");
        }
    }

    void define_label(const std::string& symbol) {
        define(symbol);
        labels_[key(symbol)] = {section_, static_cast<int32_t>(size_)};
        add(label(symbol, noted_ ? LabelKind::function : LabelKind::automatic, 0, location()));
        noted_ = false;
    }

    [[nodiscard]] Value symbol_value(const std::string& symbol) const {
        if (const auto equate = equates_.find(key(symbol)); equate != equates_.end()) {
            return equate->second;
        }
        Value value;
        if (const auto found = labels_.find(key(symbol)); found != labels_.end()) {
            value.bases.push_back(
                {symbol, static_cast<int>(found->second.section), found->second.offset});
        } else if (above_only_ || is_local(symbol) || !is_symbol(symbol_text(symbol))) {
            throw Mistake("'" + symbol + "' is not defined");
        } else {
            value.bases.push_back({symbol});
        }
        return value;
    }

    [[nodiscard]] Value here() const {
        const Base base = above_only_ ? here_base() : current_here_;
        const auto& address = module_.sections[static_cast<std::size_t>(*base.section)].address;
        Value value;
        if (address) {
            value.number = *address + base.offset;
        } else {
            value.bases.push_back(base);
        }
        return value;
    }

    [[nodiscard]] Base here_base() const {
        return {"", static_cast<int>(section_), static_cast<int32_t>(here_)};
    }

    /// A value that must be known now.
    [[nodiscard]] int32_t number(std::string_view expression) const {
        const Value value = evaluate(expression, names_);
        if (!value.bases.empty()) {
            throw Mistake(fmt::format("'{}' is an address and not a number", expression));
        }
        return value.number;
    }

    // -- Sections --------------------------------------------------------------------------------

    [[nodiscard]] Section& current() { return module_.sections[section_]; }

    void add(Item item) {
        size_ += item_size(item);
        if (current().address.value_or(0) + size_ > kMemorySize) {
            size_ -= item_size(item);
            throw Mistake("the program goes beyond 0FFFFH");
        }
        current().items.push_back(std::move(item));
    }

    void open_section(const std::string& name, SectionKind kind) {
        for (std::size_t i = 0; i < module_.sections.size(); ++i) {
            if (module_.sections[i].name != name) continue;
            if (module_.sections[i].kind != kind) {
                throw Mistake(fmt::format("section '{}' is of kind {}", name,
                                          kind_name(module_.sections[i].kind)));
            }
            section_ = i;
            size_ = section_size(current());
            return;
        }
        Section section;
        section.name = name;
        section.kind = kind;
        section.location = location();
        module_.sections.push_back(std::move(section));
        section_ = module_.sections.size() - 1;
        size_ = 0;
    }

    void section_line() {
        const auto& operands = line_.operands;
        if (operands.size() < 2) throw Mistake("SECTION takes a name and a kind");
        if (!is_symbol(operands[0])) throw Mistake("'" + operands[0] + "' cannot be a section");
        open_section(symbol_name(operands[0]), kind_of(operands[1]));
        for (std::size_t i = 2; i < operands.size(); ++i) section_option(operands[i]);
    }

    void routine_comment(std::string_view text) {
        constexpr std::array<std::string_view, 6> kKeys = {"in", "out",   "clobbers",
                                                           "t",  "calls", "stack"};
        text = trimmed(text.substr(1));
        const std::size_t space = std::min(text.find_first_of(" \t"), text.size());
        const std::string key(text.substr(0, space));
        const std::string rest(trimmed(text.substr(space)));
        if (rest.empty() || std::ranges::find(kKeys, key) == kKeys.end()) return;
        add(note(key + ' ' + rest, location()));
        noted_ = true;
    }

    void section_option(const std::string& option) {
        const std::size_t space = std::min(option.find_first_of(" \t"), option.size());
        const std::string name = upper_case(option.substr(0, space));
        const std::string value(trimmed(std::string_view(option).substr(space)));
        const auto text = string_operand(value);
        if (name == "TITLE" && text) {
            current().title = *text;
        } else if (name == "FUNCTION" && is_symbol(value)) {
            current().function = symbol_name(value);
        } else if (name == "AT") {
            current().address = static_cast<uint16_t>(number(value));
        } else if (name == "OFFSET" && number(value) >= 0) {
            current().frame_offset = static_cast<uint32_t>(number(value));
        } else if (name == "ALIGN" && number(value) > 0 &&
                   std::has_single_bit(static_cast<uint32_t>(number(value)))) {
            current().alignment = static_cast<uint32_t>(number(value));
        } else {
            throw Mistake("'" + option + "' is no option of SECTION");
        }
    }

    // -- Lines -----------------------------------------------------------------------------------

    [[nodiscard]] const std::string& sole_operand() const {
        if (line_.operands.size() != 1) throw Mistake(line_.operation + " takes one operand");
        return line_.operands[0];
    }

    /// As an address or size, so not negative.
    [[nodiscard]] uint32_t sole_size() const {
        const int32_t value = number(sole_operand());
        if (value < 0) throw Mistake(line_.operation + " of a negative number");
        return static_cast<uint32_t>(value);
    }

    bool directive() {
        const std::string& name = line_.operation;
        if (name == "EQU" && !line_.label.empty()) {
            equate();
        } else if (name == "SECTION") {
            section_line();
        } else if (name == "ORG") {
            origin(sole_size());
        } else if (name == "DS") {
            add(space(sole_size(), location()));
        } else if (name == "DB" || name == "DW") {
            if (line_.operands.empty()) throw Mistake(name + " without operands");
            for (const std::string& operand : line_.operands) data(operand, name == "DB");
        } else {
            return false;
        }
        return true;
    }

    void equate() {
        const Value value = evaluate(sole_operand(), names_);
        if (value.part != Part::word) throw Mistake("EQU of LOW or HIGH of an address");
        define(line_.label);
        equates_[key(line_.label)] = value;
        // What hangs on a local name is known in this module only, where its value is put in.
        const bool shared = value.bases.empty() ||
                            (!value.bases[0].symbol.empty() && !is_local(value.bases[0].symbol));
        if (shared && !is_local(line_.label)) {
            module_.equates.push_back({line_.label, to_operand(value), location()});
        }
    }

    void origin(uint32_t target) {
        if (current().items.empty()) {
            current().address = static_cast<uint16_t>(target);
            return;
        }
        if (!current().address) throw Mistake("ORG in a section without a fixed address");
        const uint32_t at = *current().address + static_cast<uint32_t>(size_);
        if (target < at) {
            throw Mistake(fmt::format("ORG {:04X}H goes back from {:04X}H", target, at));
        }
        if (target > at) add(space(target - at, location()));
    }

    void data(const std::string& operand, bool bytes) {
        const auto text = string_operand(operand);
        if (bytes && text) {
            add(data_bytes({text->begin(), text->end()}, location()));
        } else {
            add(bytes ? data_byte({}, location()) : data_word({}, location()));
            wait(operand);
        }
    }

    void instruction_line() {
        const auto* entry =
            find_instruction(line_.operation, line_.operands,
                             [this](std::string_view operand) { return number(operand); });
        if (entry == nullptr) {
            throw Mistake("'" + line_.operation + "' is neither instruction nor directive");
        }
        add(instruction(entry->opcode, {}, location()));
        if (entry->operand != isa::Operand::none) wait(line_.operands.back());
    }

    // -- Operands --------------------------------------------------------------------------------

    void wait(const std::string& expression) {
        pending_.push_back({section_, current().items.size() - 1, expression, here_base()});
    }

    [[nodiscard]] Item& item_of(const Pending& pending) {
        return module_.sections[pending.section].items[pending.item];
    }

    void resolve(const Pending& pending) {
        section_ = pending.section;
        current_here_ = pending.here;
        const Value value = evaluate(pending.expression, names_);
        Item& item = item_of(pending);
        const bool byte = item_size(item) == (item.kind == ItemKind::instruction ? 2u : 1u);
        if (byte && value.bases.empty() && (value.number < -128 || value.number > 255)) {
            throw Mistake(fmt::format("'{}' is beyond 8 bits", pending.expression));
        }
        item.operand = to_operand(value);
    }

    [[nodiscard]] Operand to_operand(const Value& value) {
        if (value.bases.empty()) return {"", value.number};
        const Base& base = value.bases[0];
        if (!base.symbol.empty()) return {base.symbol, value.number, value.part};
        const auto section = static_cast<std::size_t>(*base.section);
        needs_start_.insert(section);
        return {std::string(kStartLabel), value.number + base.offset, value.part};
    }

    void insert_start_labels() {
        for (const std::size_t section : needs_start_) {
            auto& items = module_.sections[section].items;
            items.insert(items.begin(), label(std::string(kStartLabel), LabelKind::label));
        }
    }

    const ParseOptions& options_;
    Module module_;
    Names names_;
    std::vector<Diagnostic> mistakes_;
    SourceLine line_;
    bool noted_ = false;  ///< a comment describes the routine that comes next
    uint32_t line_number_ = 0;
    std::size_t section_ = 0;
    std::size_t size_ = 0;    ///< of the current section
    std::size_t here_ = 0;    ///< offset of the line's first byte
    bool above_only_ = true;  ///< names must be defined above
    Base current_here_;       ///< of the operand being resolved
    std::map<std::pair<std::size_t, std::string>, uint32_t> defined_;
    std::map<std::pair<std::size_t, std::string>, LabelPlace> labels_;
    std::map<std::pair<std::size_t, std::string>, Value> equates_;
    std::vector<Pending> pending_;
    std::set<std::size_t> needs_start_;
};

}  // namespace

Module parse(std::string_view source, const ParseOptions& options) {
    return Parser(options).run(source);
}

}  // namespace toolchain::assembly
