// link.cpp - see link.hpp. The steps in their order: reach, RAM, start-up, ROM, symbols, bytes.
#include "toolchain/asm/link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <unordered_set>
#include <utility>

#include "toolchain/asm/encode.hpp"
#include "toolchain/asm/free_space.hpp"
#include "toolchain/asm/reach.hpp"

namespace toolchain::assembly {
namespace {

constexpr uint8_t kJmp = 0xC3;
constexpr std::size_t kLargestShown = 5;
constexpr std::array<uint16_t, 4> kInterruptLines = {0x24, 0x2C, 0x34, 0x3C};

[[noreturn]] void fail(const std::string& text) {
    throw Error({Diagnostic{{}, 0, text}});
}

std::string range_text(uint32_t first, uint32_t size) {
    return size == 0 ? fmt::format("{:04X}H", first)
                     : fmt::format("{:04X}H-{:04X}H", first, first + size - 1);
}

/// A JMP with a name, as section and as label.
Section vector_section(uint32_t address, LabelKind kind, const Operand& target) {
    if (address >= kMemorySize) {
        fail(fmt::format("a vector goes beyond 0FFFFH, to {:X}H: choose a lower base", address));
    }
    Section section;
    section.name = section.function = fmt::format("__vector_{:04X}", address);
    section.address = static_cast<uint16_t>(address);
    section.items = {label(section.name, kind), instruction(kJmp, target)};
    return section;
}

Module vector_module(const std::map<uint16_t, std::string>& vectors, const LinkOptions& options) {
    Module module;
    module.name = "vectors";
    for (const auto& [address, target] : vectors) {
        const LabelKind kind = address == 0 ? LabelKind::function : LabelKind::interrupt_entry;
        module.sections.push_back(
            vector_section(uint32_t{options.vector_base} + address, kind, {target}));
    }
    if (!options.forward_to) return module;
    for (const uint16_t address : kInterruptLines) {
        const uint32_t target = uint32_t{*options.forward_to} + address;
        module.sections.push_back(vector_section(address, LabelKind::interrupt_entry,
                                                 Operand{.offset = static_cast<int32_t>(target)}));
    }
    return module;
}

class Linker {
public:
    Linker(std::vector<Module> modules, const LinkOptions& options)
        : modules_(std::move(modules)), options_(options), rom_(options.rom), ram_(options.ram) {
        program_.rom = options.rom;
        program_.ram = options.ram;
    }

    Program run() {
        auto vectors = options_.vectors;
        if (options_.startup) vectors.emplace(0, options_.startup->name);
        modules_.push_back(vector_module(vectors, options_));
        keep_reachable();
        place_fixed();
        place_ram();
        make_start();
        place_rom();
        define_symbols();
        encode_all();
        if (const auto reset = vectors.find(0); reset != vectors.end()) {
            if (const Symbol* symbol = program_.find(reset->second)) program_.start = symbol->value;
        }
        return std::move(program_);
    }

private:
    // -- What is kept ----------------------------------------------------------------------------

    [[nodiscard]] std::vector<std::string> roots() const {
        std::vector<std::string> names = options_.roots;
        if (options_.startup) {
            names.push_back(options_.startup->main);
            const auto& constructors = options_.startup->constructors;
            names.insert(names.end(), constructors.begin(), constructors.end());
        }
        return names;
    }

    void keep_reachable() {
        const NameIndex index(modules_);
        std::vector<std::string> names = roots();
        check_roots(index, names);
        for (const Section* section : index.sections()) {
            if (!section->address) continue;
            for (const Item& item : section->items) {
                const std::string_view name = reference_of(item);
                if (!name.empty() && !is_local(name)) names.emplace_back(name);
            }
        }
        const auto kept = index.reachable(names, [](const Section&) { return false; });
        std::size_t number = 0;
        for (Module& module : modules_) {
            const auto first_file = static_cast<uint32_t>(program_.files.size());
            program_.files.insert(program_.files.end(), module.files.begin(), module.files.end());
            for (Section& section : module.sections) {
                if (kept[number++] || section.address) take(section, first_file);
            }
            for (const Equate& equate : module.equates) {
                equates_.push_back(equate);
                equates_.back().location.file += first_file;
            }
        }
    }

    static void check_roots(const NameIndex& index, const std::vector<std::string>& names) {
        std::vector<Diagnostic> mistakes;
        for (const std::string& name : names) {
            if (index.section_of(name)) continue;
            mistakes.push_back(
                {{}, 0, fmt::format("'{}' is to be linked, but no module defines it", name)});
        }
        if (!mistakes.empty()) throw Error(std::move(mistakes));
    }

    void take(Section& section, uint32_t first_file) {
        section.location.file += first_file;
        for (Item& item : section.items) item.location.file += first_file;
        PlacedSection placed;
        placed.size = static_cast<uint32_t>(section_size(section));
        placed.section = std::move(section);
        program_.sections.push_back(std::move(placed));
    }

    // -- Places ----------------------------------------------------------------------------------

    static void put_at(PlacedSection& placed, uint32_t address) {
        placed.address = placed.load_address = static_cast<uint16_t>(address);
    }

    void place_fixed() {
        std::vector<const PlacedSection*> fixed;
        for (PlacedSection& placed : program_.sections) {
            const Section& section = placed.section;
            if (!section.address) continue;
            if (section.kind != SectionKind::code && section.kind != SectionKind::constant &&
                section.kind != SectionKind::persistent) {
                fail(
                    fmt::format("section '{}' is of kind {} and cannot have a fixed address; "
                                "persistent, code and constant can",
                                section.name, kind_name(section.kind)));
            }
            if (*section.address + placed.size > kMemorySize) {
                fail(fmt::format("section '{}' goes beyond 0FFFFH: {} bytes at {:04X}H",
                                 section.name, placed.size, *section.address));
            }
            put_at(placed, *section.address);
            for (const PlacedSection* other : fixed) check_apart(*other, placed);
            if (placed.size != 0) fixed.push_back(&placed);
            rom_.remove({*section.address, placed.size});
            ram_.remove({*section.address, placed.size});
        }
    }

    static void check_apart(const PlacedSection& one, const PlacedSection& other) {
        if (one.address >= other.address + other.size || other.address >= one.address + one.size) {
            return;
        }
        fail(fmt::format("section '{}' at {} overlaps '{}' at {}", other.section.name,
                         range_text(other.address, other.size), one.section.name,
                         range_text(one.address, one.size)));
    }

    /// Sections of one kind, which lie together.
    struct Block {
        SectionKind kind = SectionKind::zero;
        uint32_t size = 0;
        uint32_t alignment = 1;
    };

    /// Lays the sections of a kind out from 0 on: the most aligned ones first, others in their
    /// gaps.
    Block lay_out(SectionKind kind) {
        Block block{.kind = kind};
        std::vector<PlacedSection*> order;
        for (PlacedSection& placed : program_.sections) {
            if (placed.section.kind == kind && !placed.section.address) order.push_back(&placed);
        }
        const auto alignment_of = [](const PlacedSection* placed) {
            return placed->section.alignment;
        };
        std::ranges::stable_sort(order, std::greater{}, alignment_of);
        FreeSpace offsets({0, kMemorySize - 1});
        for (PlacedSection* placed : order) {
            uint32_t offset = placed->section.frame_offset;
            if (kind != SectionKind::frame) {
                const auto free = offsets.take(placed->size, alignment_of(placed));
                offset = free.value_or(block.size);  // more than 64 KB: refused as a whole
            }
            put_at(*placed, offset);
            block.size = std::max(block.size, offset + placed->size);
            block.alignment = std::max(block.alignment, alignment_of(placed));
        }
        if (kind == SectionKind::zero && options_.startup) block.size += block.size % 2;
        return block;
    }

    Region place_block(const Block& block) {
        const auto first =
            block.size == 0 ? options_.ram.first : ram_.take(block.size, block.alignment);
        if (!first) fail(full(ram_, "RAM", options_.ram, block.size));
        for (PlacedSection& placed : program_.sections) {
            if (placed.section.kind == block.kind && !placed.section.address) {
                put_at(placed, placed.address + *first);
            }
        }
        return {*first, block.size};
    }

    void place_ram() {
        program_.stack.size = options_.stack_size;
        const auto stack =
            options_.stack_size == 0 ? options_.ram.last + 1u : ram_.take_top(options_.stack_size);
        if (!stack) fail(full(ram_, "RAM", options_.ram, options_.stack_size));
        program_.stack.first = *stack;
        std::vector<Block> blocks;
        for (const SectionKind kind : {SectionKind::frame, SectionKind::initialised,
                                       SectionKind::zero, SectionKind::persistent}) {
            blocks.push_back(lay_out(kind));
        }
        std::ranges::stable_sort(blocks, std::greater{}, &Block::alignment);
        for (const Block& block : blocks) {
            const Region region = place_block(block);
            if (block.kind == SectionKind::frame) program_.frames = region;
            if (block.kind == SectionKind::initialised) program_.data = region;
            if (block.kind == SectionKind::zero) program_.zero = region;
        }
    }

    [[nodiscard]] Startup build_startup() const {
        const auto stack_end = static_cast<uint16_t>(program_.stack.end());
        return make_startup(*options_.startup,
                            {program_.data, program_.data_image, program_.zero, stack_end});
    }

    /// Its size does not depend on where the image of the data will be, so it has one before.
    void make_start() {
        if (!options_.startup) return;
        Startup startup = build_startup();
        program_.startup_t_states = startup.t_states;
        startup_ = program_.sections.size();
        take(startup.section, 0);
    }

    void place_rom() {
        for (PlacedSection& placed : program_.sections) {
            if (!in_rom(placed.section.kind) || placed.section.address) continue;
            const auto address = rom_.take(placed.size, placed.section.alignment);
            if (!address) fail(full(rom_, "ROM", options_.rom, placed.size));
            put_at(placed, *address);
        }
        program_.data_image.size = program_.data.size;
        const auto image =
            program_.data.size == 0 ? options_.rom.first : rom_.take(program_.data.size);
        if (!image) fail(full(rom_, "ROM", options_.rom, program_.data.size));
        program_.data_image.first = *image;
        for (PlacedSection& placed : program_.sections) {
            if (placed.section.kind != SectionKind::initialised) continue;
            placed.load_address =
                static_cast<uint16_t>(placed.address - program_.data.first + *image);
        }
        if (options_.startup)
            program_.sections[startup_].section.items = build_startup().section.items;
        std::ranges::stable_sort(program_.sections, {}, &PlacedSection::address);
    }

    /// Why a range is full.
    [[nodiscard]] std::string full(const FreeSpace& free, std::string_view name, AddressRange range,
                                   uint32_t missing) const {
        const bool rom = name == "ROM";
        std::vector<std::pair<uint32_t, std::string>> sizes;
        uint32_t needed = rom ? 0 : options_.stack_size;
        uint32_t frames = 0;
        for (const PlacedSection& placed : program_.sections) {
            const SectionKind kind = placed.section.kind;
            if (kind == SectionKind::frame) {
                frames = std::max(frames, placed.section.frame_offset + placed.size);
            }
            const bool counts = rom ? in_rom(kind) || kind == SectionKind::initialised
                                    : !in_rom(kind) && kind != SectionKind::frame;
            const uint32_t fixed = placed.section.address.value_or(range.first);
            if (!counts || fixed < range.first || fixed > range.last) continue;
            needed += placed.size;
            sizes.emplace_back(placed.size, placed.section.name);
        }
        if (!rom) {
            needed += frames;
            sizes.emplace_back(frames, "frames");
            sizes.emplace_back(options_.stack_size, "stack");
        }
        std::ranges::stable_sort(sizes, std::greater{}, [](const auto& one) { return one.first; });
        std::string text = fmt::format("{}: {} bytes needed, {} there ({})", name, needed,
                                       range.size(), range_text(range.first, range.size()));
        if (needed > range.size()) {
            text += fmt::format(", {} too many", needed - range.size());
        } else {
            text += fmt::format(", but no gap for {} of them; the largest has {}", missing,
                                free.largest_gap());
        }
        text += "; largest:";
        for (std::size_t i = 0; i < std::min(sizes.size(), kLargestShown); ++i) {
            if (sizes[i].first != 0)
                text += fmt::format(" {} {},", sizes[i].second, sizes[i].first);
        }
        text.pop_back();
        return text;
    }

    // -- Symbols ---------------------------------------------------------------------------------

    void define_symbols() {
        for (std::size_t i = 0; i < program_.sections.size(); ++i) define_labels(i);
        std::unordered_set<std::string> names;
        for (const Symbol& symbol : program_.symbols) names.insert(symbol.name);
        for (const auto& [name, value] : linker_symbols(program_)) {
            if (!names.insert(std::string(name)).second) continue;
            program_.symbols.push_back({std::string(name), value});
        }
        define_equates();
        std::ranges::stable_sort(program_.symbols, {}, &Symbol::value);
    }

    static LabelKind resolved_kind(const Item& item, const Section& section, bool first) {
        if (item.label_kind != LabelKind::automatic) return item.label_kind;
        if (is_local(item.operand.symbol)) return LabelKind::label;
        if (section.kind != SectionKind::code) return LabelKind::data;
        return first ? LabelKind::function : LabelKind::label;
    }

    void define_labels(std::size_t index) {
        const PlacedSection& placed = program_.sections[index];
        bool is_open = false;  // the end of the symbol `open` is not known yet
        std::size_t open = 0;
        uint32_t address = placed.address;
        const auto close = [&] {
            if (!is_open) return;
            program_.symbols[open].size = address - program_.symbols[open].value;
            is_open = false;
        };
        bool first = true;
        for (const Item& item : placed.section.items) {
            if (item.kind == ItemKind::label) {
                const LabelKind kind = resolved_kind(item, placed.section, first);
                if (kind != LabelKind::label) close();
                first = first && is_local(item.operand.symbol);
                program_.symbols.push_back({item.operand.symbol, static_cast<uint16_t>(address),
                                            item.size, kind, index, item.location});
                if (kind != LabelKind::label && item.size == 0) {
                    open = program_.symbols.size() - 1;
                    is_open = true;
                }
            }
            address += static_cast<uint32_t>(item_size(item));
        }
        close();
    }

    /// EQUs may name each other in any order.
    void define_equates() {
        std::vector<Equate> left = equates_;
        for (bool progress = true; progress && !left.empty();) {
            progress = false;
            const SymbolValues values(program_);
            std::erase_if(left, [&](const Equate& equate) {
                const Operand& operand = equate.value;
                std::optional<uint16_t> base = uint16_t{0};
                if (!operand.symbol.empty()) base = values.find(operand.symbol, 0);
                if (!base) return false;
                program_.symbols.push_back({equate.name,
                                            static_cast<uint16_t>(*base + operand.offset), 0,
                                            LabelKind::label, std::nullopt, equate.location});
                progress = true;
                return true;
            });
        }
    }

    // -- Bytes -----------------------------------------------------------------------------------

    void encode_all() {
        const SymbolValues values(program_);
        std::vector<Diagnostic> mistakes;
        std::unordered_set<std::string> reported;
        for (std::size_t i = 0; i < program_.sections.size(); ++i) {
            const PlacedSection& placed = program_.sections[i];
            const bool stored =
                in_rom(placed.section.kind) || placed.section.kind == SectionKind::initialised;
            uint32_t address = placed.load_address;
            for (const Item& item : placed.section.items) {
                try {
                    const auto bytes = encode(item, i, values);
                    if (stored) store(address, bytes);
                    check_content(placed, item);
                } catch (const Mistake& mistake) {
                    if (reported.insert(mistake.what()).second) {
                        mistakes.push_back(diagnostic(placed, item, mistake.what()));
                    }
                }
                address += static_cast<uint32_t>(item_size(item));
            }
        }
        if (!mistakes.empty()) throw Error(std::move(mistakes));
    }

    /// RAM that nobody copies to cannot begin with anything but space.
    static void check_content(const PlacedSection& placed, const Item& item) {
        const SectionKind kind = placed.section.kind;
        if (in_rom(kind) || kind == SectionKind::initialised || item_size(item) == 0 ||
            item.kind == ItemKind::space) {
            return;
        }
        throw Mistake(fmt::format("section '{}' is of kind {} and holds space only",
                                  placed.section.name, kind_name(kind)));
    }

    Diagnostic diagnostic(const PlacedSection& placed, const Item& item,
                          const std::string& text) const {
        const Location location = item.location.known() ? item.location : placed.section.location;
        if (location.known() && location.file < program_.files.size()) {
            return {program_.files[location.file], location.line, text};
        }
        return {placed.section.name, 0, text};
    }

    void store(uint32_t address, const std::vector<uint8_t>& bytes) {
        for (const uint8_t byte : bytes) {
            program_.image.bytes[address] = byte;
            program_.image.present.set(address++);
        }
    }

    std::vector<Module> modules_;
    const LinkOptions& options_;
    FreeSpace rom_;
    FreeSpace ram_;
    Program program_;
    std::vector<Equate> equates_;
    std::size_t startup_ = 0;  ///< its section, if there is one, until sections are sorted
};

}  // namespace

std::vector<std::pair<std::string_view, uint16_t>> linker_symbols(const Program& program) {
    const auto word = [](uint32_t address) { return static_cast<uint16_t>(address); };
    return {{"__frames_start", word(program.frames.first)},
            {"__frames_end", word(program.frames.end())},
            {"__data_start", word(program.data.first)},
            {"__data_end", word(program.data.end())},
            {"__data_image", word(program.data_image.first)},
            {"__zero_start", word(program.zero.first)},
            {"__zero_end", word(program.zero.end())},
            {"__stack_start", word(program.stack.first)},
            {"__stack_end", word(program.stack.end())}};
}

Program link(std::vector<Module> modules, const LinkOptions& options) {
    return Linker(std::move(modules), options).run();
}

}  // namespace toolchain::assembly
