// map_file.cpp - see map_file.hpp.
#include "toolchain/asm/map_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bitset>
#include <iterator>
#include <map>
#include <string_view>

#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::assembly {
namespace {

/// The numbers of a note that begins with `key`.
std::optional<std::vector<uint32_t>> note_numbers(const Item& item, std::string_view key) {
    if (item.kind != ItemKind::note) return {};
    std::string_view rest = item.text;
    if (!rest.starts_with(key) || rest.size() == key.size() || rest[key.size()] != ' ') return {};
    rest.remove_prefix(key.size());
    std::vector<uint32_t> numbers;
    bool inside = false;
    for (const char letter : rest) {
        const bool digit = letter >= '0' && letter <= '9';
        if (digit && !inside) numbers.push_back(0);
        if (digit) numbers.back() = numbers.back() * 10 + static_cast<uint32_t>(letter - '0');
        inside = digit;
    }
    if (numbers.empty()) return {};
    return numbers;
}

const std::string& owner(const Section& section) {
    return section.function.empty() ? section.name : section.function;
}

void take_code(FunctionSizes& function, const PlacedSection& placed) {
    const Section& section = placed.section;
    if (!section.title.empty()) function.title = section.title;
    if (const auto t = straight_t_states(section)) function.t_states = TStates{*t, *t};
    for (const Item& item : section.items) {
        if (const auto t = note_numbers(item, "t")) {
            const TStates known = function.t_states.value_or(TStates{t->front(), t->back()});
            function.t_states =
                TStates{std::min(known.least, t->front()), std::max(known.most, t->back())};
        }
        if (const auto stack = note_numbers(item, "stack")) {
            function.stack_bytes = std::max(function.stack_bytes.value_or(0), stack->front());
        }
    }
}

uint32_t used_bytes(const Program& program, AddressRange range, bool rom) {
    std::bitset<kMemorySize> used;
    const auto mark = [&](const Region& region) {
        for (uint32_t at = region.first; at < region.end(); ++at) used.set(at);
    };
    for (const PlacedSection& placed : program.sections) mark({placed.address, placed.size});
    mark(program.data_image);
    mark(program.zero);
    if (!rom) mark(program.stack);
    uint32_t count = 0;
    for (uint32_t at = range.first; at <= range.last; ++at) count += used[at] ? 1u : 0u;
    return count;
}

std::string number_or_dash(const std::optional<uint32_t>& number) {
    return number ? std::to_string(*number) : "-";
}

class MapWriter {
public:
    explicit MapWriter(const Program& program) : program_(program) {}

    std::string run() {
        out_ = "# rover85 map 1\n";
        range("ROM", program_.rom, true);
        range("RAM", program_.ram, false);
        region("frames", program_.frames);
        region("data", program_.data);
        region("image", program_.data_image);
        region("zero", program_.zero);
        region("stack", program_.stack);
        if (program_.startup_t_states) add("startup {}\n", *program_.startup_t_states);
        for (const PlacedSection& placed : program_.sections) {
            add("section {:04X} {:04X} {} {:04X} {}\n", placed.address, placed.size,
                kind_name(placed.section.kind), placed.load_address, placed.section.name);
        }
        for (const FunctionSizes& one : function_sizes(program_)) function(one);
        for (const PlacedSection& placed : program_.sections) notes(placed);
        return std::move(out_);
    }

private:
    template <typename... Parts>
    void add(fmt::format_string<Parts...> form, Parts&&... parts) {
        fmt::format_to(std::back_inserter(out_), form, std::forward<Parts>(parts)...);
    }

    void range(std::string_view name, AddressRange range, bool rom) {
        const uint32_t used = used_bytes(program_, range, rom);
        add("range {} {:04X} {:04X} used {} free {}\n", name, range.first, range.last, used,
            range.size() - used);
    }

    void region(std::string_view name, const Region& region) {
        add("region {} {:04X} {:04X}\n", name, region.first & 0xFFFF, region.size);
    }

    void function(const FunctionSizes& one) {
        std::optional<uint32_t> least;
        std::optional<uint32_t> most;
        if (one.t_states) {
            least = one.t_states->least;
            most = one.t_states->most;
        }
        add("function {:04X} rom {} ram {} t {} {} stack {} {}\n", one.address, one.rom_bytes,
            one.ram_bytes, number_or_dash(least), number_or_dash(most),
            number_or_dash(one.stack_bytes), one.title.empty() ? one.name : one.title);
    }

    void notes(const PlacedSection& placed) {
        uint32_t address = placed.address;
        for (const Item& item : placed.section.items) {
            if (item.kind == ItemKind::note) add("note {:04X} {}\n", address, item.text);
            address += static_cast<uint32_t>(item_size(item));
        }
    }

    const Program& program_;
    std::string out_;
};

}  // namespace

std::optional<uint32_t> straight_t_states(const Section& section) {
    if (section.kind != SectionKind::code) return {};
    uint32_t t = 0;
    bool ended = false;
    for (const Item& item : section.items) {
        if (item_size(item) == 0) continue;
        if (ended || item.kind != ItemKind::instruction) return {};
        const isa::Instruction& entry = isa::instruction(item.opcode);
        if (entry.conditional()) return {};
        if (entry.flow != isa::Flow::next && entry.flow != isa::Flow::ret) return {};
        ended = entry.flow == isa::Flow::ret;
        t += entry.t_taken;
    }
    if (!ended) return {};
    return t;
}

std::vector<FunctionSizes> function_sizes(const Program& program) {
    std::vector<FunctionSizes> functions;
    std::map<std::string, std::size_t, std::less<>> by_name;
    for (const PlacedSection& placed : program.sections) {
        if (placed.section.kind != SectionKind::code) continue;
        const auto [found, is_new] = by_name.emplace(owner(placed.section), functions.size());
        if (is_new) {
            functions.push_back({});
            functions.back().name = found->first;
            functions.back().address = placed.address;
        }
        take_code(functions[found->second], placed);
    }
    for (const PlacedSection& placed : program.sections) {
        const auto found = by_name.find(owner(placed.section));
        if (found == by_name.end()) continue;
        FunctionSizes& function = functions[found->second];
        (in_rom(placed.section.kind) ? function.rom_bytes : function.ram_bytes) += placed.size;
    }
    return functions;
}

std::string map_file(const Program& program) {
    return MapWriter(program).run();
}

}  // namespace toolchain::assembly
