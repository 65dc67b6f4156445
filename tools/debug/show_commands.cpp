// show_commands.cpp - commands that show and change registers and memory. See commands.hpp.
#include <algorithm>

#include "toolchain/isa/disassemble.hpp"
#include "tools/debug/console.hpp"
#include "tools/debug/registers.hpp"

namespace debug_console {

using host_sim::BoardState;
using host_sim::CpuState;
using host_sim::Pin;
using toolchain::isa::intel_hex;

namespace {

constexpr unsigned kDumpBytes = 64;
constexpr unsigned kDumpRow = 16;
constexpr unsigned kListedInstructions = 8;
constexpr unsigned kStackWords = 8;
constexpr int64_t kListingMax = 0x10000;

// -- Registers
// ------------------------------------------------------------------------------------------------

void registers(Console& console, Arguments& arguments) {
    arguments.expect_end();
    const CpuState& cpu = console.session.board.state.cpu;
    const auto pin = [&cpu](Pin which) { return cpu.pin(which).level ? 1 : 0; };
    console.print("PC {}  SP {}\n", console.session.names.address_text(cpu.pc),
                  intel_hex(cpu.sp, 4));
    console.print("A {}  BC {}  DE {}  HL {}\n", intel_hex(cpu.a, 2), intel_hex(cpu.bc(), 4),
                  intel_hex(cpu.de(), 4), intel_hex(cpu.hl(), 4));
    console.print("F {}: {}\n", intel_hex(cpu.f, 2), flags_text(cpu.f));
    console.print("IE {}, masked {}, pending {}{}\n", cpu.interrupt_enable ? 1 : 0,
                  masks_text(cpu.masks), pending_text(cpu), cpu.halted ? ", in HALT" : "");
    console.print("pins TRAP {}, RST 7.5 {}, RST 6.5 {}, RST 5.5 {}, SID {}, SOD {}\n",
                  pin(Pin::trap), pin(Pin::rst75), pin(Pin::rst65), pin(Pin::rst55), pin(Pin::sid),
                  cpu.sod ? 1 : 0);
    console.print("{}, {} instructions\n", time_text(cpu.t), cpu.instructions);
}

void set(Console& console, Arguments& arguments) {
    const std::string name = arguments.word("REGISTER");
    const auto which = find_register(name);
    if (!which) {
        throw DebugError(fmt::format("{}: no register; memory is changed with `poke`", name));
    }
    arguments.take("=");
    const int64_t value = console.take_value(arguments, "VALUE", -0x8000, 0xFFFF);
    arguments.expect_end();
    set_register(console.session.board.state.cpu, *which, value);
    if (*which == Register::sp) console.session.state_changed();
}

void print_value(Console& console, Arguments& arguments) {
    if (arguments.empty()) throw DebugError("VALUE is missing");
    const std::string text = arguments.take_rest();
    const int64_t value =
        Expression::parse(text, console.session.names).value(console.session.board.state);
    console.print("{}", value);
    if (value >= 0 && value <= 0xFFFF) {
        const std::string name =
            value > 0xFF ? console.session.names.near(static_cast<uint16_t>(value)) : "";
        console.print(" = {}{}{}", intel_hex(static_cast<unsigned>(value), value > 0xFF ? 4 : 2),
                      name.empty() ? "" : " ", name);
    }
    console.write("\n");
}

// -- Memory
// ------------------------------------------------------------------------------------------------

void dump_row(Console& console, unsigned address, unsigned count) {
    const auto& bytes = console.session.board.state.memory.bytes;
    std::string numbers, text;
    for (unsigned i = 0; i < count; ++i) {
        const uint8_t byte = bytes[address + i];
        numbers += fmt::format(" {:02X}", byte);
        text += byte >= ' ' && byte <= '~' ? static_cast<char>(byte) : '.';
    }
    console.print("{:04X} {:<48}  {}\n", address, numbers, text);
}

void memory(Console& console, Arguments& arguments) {
    unsigned address = console.next_dump, count = kDumpBytes;
    if (!arguments.empty()) {
        const bool range = arguments.peek().find("..") != std::string_view::npos;
        const Console::Range wanted = console.take_range(arguments);
        address = wanted.first;
        if (range) count = wanted.last - wanted.first + 1U;
    }
    if (!arguments.empty()) {
        count = static_cast<unsigned>(console.take_value(arguments, "COUNT", 1, 0x10000));
    }
    arguments.expect_end();
    count = std::min(count, 0x10000 - address);
    for (unsigned row = 0; row < count; row += kDumpRow) {
        dump_row(console, address + row, std::min(kDumpRow, count - row));
    }
    console.next_dump = static_cast<uint16_t>(address + count);
}

std::vector<uint8_t> take_bytes(Console& console, Arguments& arguments) {
    std::vector<uint8_t> bytes;
    while (!arguments.empty()) {
        if (const auto text = arguments.take_quoted()) {
            bytes.insert(bytes.end(), text->begin(), text->end());
        } else {
            bytes.push_back(static_cast<uint8_t>(console.take_value(arguments, "BYTE", 0, 0xFF)));
        }
    }
    if (bytes.empty()) throw DebugError("BYTE is missing");
    return bytes;
}

void poke(Console& console, Arguments& arguments) {
    const unsigned address = console.take_address(arguments);
    const std::vector<uint8_t> bytes = take_bytes(console, arguments);
    host_sim::Board& board = console.session.board;
    const auto& map = board.state.map;
    for (unsigned i = 0; i < bytes.size(); ++i) {
        const unsigned at = address + i;
        if (at > 0xFFFF || (at > map.eeprom_last && (at < map.ram_first || at > map.ram_last))) {
            throw DebugError(
                fmt::format("{}: no memory there; nothing was changed", intel_hex(at, 4)));
        }
    }
    for (unsigned i = 0; i < bytes.size(); ++i) {
        const auto at = static_cast<uint16_t>(address + i);
        if (at <= map.eeprom_last) {
            board.program({&bytes[i], 1}, at);
        } else {
            board.state.memory.bytes[at] = bytes[i];
        }
    }
}

// -- Program
// ------------------------------------------------------------------------------------------------

void disassemble_lines(Console& console, Arguments& arguments) {
    uint16_t address = console.next_listing.value_or(console.session.board.state.cpu.pc);
    int64_t count = kListedInstructions;
    if (!arguments.empty()) address = console.take_address(arguments);
    if (!arguments.empty()) count = console.take_value(arguments, "COUNT", 1, kListingMax);
    arguments.expect_end();
    for (int64_t i = 0; i < count; ++i) {
        for (const std::string& label : console.session.names.at(address)) {
            console.print("{}:\n", label);
        }
        uint8_t bytes = 0;
        console.print("{}\n", console.listing_line(address, bytes));
        address = static_cast<uint16_t>(address + bytes);
    }
    console.next_listing = address;
}

void stack(Console& console, Arguments& arguments) {
    unsigned count = kStackWords;
    if (!arguments.empty()) {
        count = static_cast<unsigned>(console.take_value(arguments, "COUNT", 1, 0x8000));
    }
    arguments.expect_end();
    const BoardState& state = console.session.board.state;
    const auto byte = [&state](unsigned at) {
        return state.memory.bytes[static_cast<uint16_t>(at)];
    };
    for (unsigned i = 0; i < count; ++i) {
        const unsigned slot = state.cpu.sp + 2 * i;
        if (i > 0 && slot > 0xFFFF) break;
        const auto word = static_cast<uint16_t>(byte(slot) | byte(slot + 1) << 8);
        console.print("{:04X}  {}\n", slot & 0xFFFF, console.session.names.address_text(word));
    }
}

std::string frame_text(const Frame& frame, const Names& names) {
    const std::string from = names.address_text(frame.from);
    const std::string target = names.address_text(frame.target);
    using Kind = host_sim::StepRecord::Kind;
    switch (frame.kind) {
        case Frame::Kind::call:
            return fmt::format("{} {} from {}", target, frame.guessed ? "perhaps called" : "called",
                               from);
        case Frame::Kind::restart:
            return fmt::format("{} restarted from {}", target, from);
        default:
            break;
    }
    const auto kind = frame.kind == Frame::Kind::trap    ? Kind::trap
                      : frame.kind == Frame::Kind::rst75 ? Kind::rst75
                      : frame.kind == Frame::Kind::rst65 ? Kind::rst65
                      : frame.kind == Frame::Kind::rst55 ? Kind::rst55
                                                         : Kind::intr;
    return fmt::format("{} by {} at {}", target, debug_console::interrupt_name(kind), from);
}

void where(Console& console, Arguments& arguments) {
    arguments.expect_end();
    const BoardState& state = console.session.board.state;
    const Names& names = console.session.names;
    console.print("#0  {}\n", names.address_text(state.cpu.pc));
    unsigned number = 0;
    for (const Frame& frame : console.session.calls.backtrace(state)) {
        console.print("#{}  {}\n", ++number, frame_text(frame, names));
    }
}

void symbols(Console& console, Arguments& arguments) {
    const std::string part = arguments.empty() ? std::string() : arguments.word("PART");
    arguments.expect_end();
    const auto list = console.session.names.containing(part);
    if (list.empty()) {
        console.write(part.empty() ? "no symbols; --symbols FILE loads some\n"
                                   : "no symbol has that in its name\n");
    }
    for (const host_sim::Symbol& symbol : list) {
        console.print("{:04X}  {}\n", symbol.address, symbol.name);
    }
}

}  // namespace

std::vector<Command> show_commands() {
    return {
        {"registers", "r", "registers", "registers, flags, interrupts, pins, time", "  registers\n",
         registers},
        {"set", "", "set REGISTER VALUE", "change a register, a flag or IE",
         "Registers: A F B C D E H L BC DE HL PSW SP PC MASKS; flags: S Z K AC P V CY; and IE.\n"
         "  set A 0A3H\n  set HL buffer+2\n  set CY 1\n",
         set},
        {"print", "p", "print VALUE", "compute a value",
         "Numbers are 0A3H, 0x00A3, 1010B, 163 or 'A'; $ is PC, T the T-states, N the\n"
         "instructions; [ADDRESS] is a byte of memory, word[ADDRESS] two; + and - join them.\n"
         "  print word[SP]\n  print buffer+HL-1\n",
         print_value},
        {"disassemble", "d", "disassemble [ADDRESS [COUNT]]", "list instructions with T-states",
         "Without ADDRESS from PC, or where the last listing ended. > marks PC, * a breakpoint;\n"
         "7/10 T is not taken/taken.\n"
         "  disassemble\n  disassemble main 20\n",
         disassemble_lines},
        {"memory", "m", "memory [ADDRESS[..ADDRESS] [COUNT]]", "show bytes and their characters",
         "Without ADDRESS where the last one ended.\n"
         "  memory 8000H\n  memory buffer 16\n  memory 0FF00H..0FFFFH\n",
         memory},
        {"poke", "", "poke ADDRESS BYTE|\"TEXT\"...", "write bytes to RAM or EEPROM, in no time",
         "  poke 8000H 1 2 3\n  poke buffer \"ready\\n\" 0\n", poke},
        {"stack", "", "stack [COUNT]", "words from SP upward", "  stack\n  stack 20\n", stack},
        {"where", "bt", "where", "the calls and interrupts that have not returned",
         "Those seen while stepping are certain; what else memory suggests is marked perhaps.\n"
         "  where\n",
         where},
        {"symbols", "", "symbols [PART]", "symbols whose name contains PART, or all",
         "  symbols adc\n", symbols},
    };
}

}  // namespace debug_console
