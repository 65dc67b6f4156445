// volatile_program.cpp - see volatile_program.hpp.
#include "tests/target/volatile_program.hpp"

#include <fmt/format.h>

#include <array>
#include <functional>
#include <map>
#include <random>
#include <utility>

namespace target_test {

namespace {

constexpr std::size_t kAccessLimit = 3000;  ///< a program that makes more is cut short

/// What the abstract machine knows.
struct State {
    uint64_t seed = 0;
    uint64_t reads = 0;
    std::map<std::string, uint64_t> plain;  ///< values of ordinary variables
    std::vector<Access> accesses;

    uint64_t outside(Access access) {
        access.value = outside_value(seed, reads++) & (~uint64_t{0} >> (64 - 8 * access.bytes));
        accesses.push_back(access);
        return access.value;
    }
};

using Action = std::function<void(State&)>;
using Value = std::function<uint64_t(State&)>;

struct Statement {
    std::string text;
    Action run;
};
struct Expression {
    std::string text;
    Value value;
};

struct Variable {
    std::string name;
    unsigned bytes = 1;
};

std::string type_name(unsigned bytes) {
    return fmt::format("uint{}_t", 8 * bytes);
}

uint64_t cut(uint64_t value, unsigned bytes) {
    return value & (~uint64_t{0} >> (64 - 8 * bytes));
}

/// Four elements, in RAM or at an address.
Device array(const std::string& name, unsigned bytes, uint16_t address) {
    Device made{.name = name,
                .declaration = fmt::format("volatile {} {}[4];", type_name(bytes), name),
                .parts = {},
                .address = address};
    for (unsigned i = 0; i < 4; ++i)
        made.parts.push_back({fmt::format("[{}]", i), i * bytes, bytes});
    if (address != 0) {
        made.declaration =
            fmt::format("#define {} ((volatile {} *)0x{:X}u)", name, type_name(bytes), address);
    }
    return made;
}

class Writer {
public:
    explicit Writer(uint64_t seed) : random_(seed) {
        for (const unsigned bytes : {1U, 1U, 2U, 2U, 4U}) {
            plain_.push_back({fmt::format("g{}", plain_.size()), bytes});
        }
        for (const unsigned bytes : {1U, 2U, 4U}) {
            const std::string name = fmt::format("v{}", 8 * bytes);
            devices_.push_back(
                {name, fmt::format("volatile {} {};", type_name(bytes), name), {{"", 0, bytes}}});
        }
        devices_.push_back(array("a8", 1, 0));
        devices_.push_back(array("a16", 2, 0));
        devices_.push_back(array("m16", 2, 0xFF10));  // beyond RAM
        devices_.push_back(array("m8", 1, 0xFF20));
        devices_.push_back({"s",
                            "volatile struct { uint8_t a; uint16_t b; uint32_t c; } s;",
                            {{".a", 0, 1}, {".b", 1, 2}, {".c", 3, 4}}});
    }

    VolatileProgram make(uint64_t seed);

private:
    uint32_t below(uint32_t limit) { return static_cast<uint32_t>(random_() >> 33) % limit; }
    Expression leaf(unsigned bytes);
    Expression expression(unsigned bytes, int depth);
    Statement statement(int depth);
    Statement block(int depth, uint32_t statements);
    Statement device_statement();
    Statement port_statement();
    Statement branch(int depth);
    Statement loop(int depth);
    Statement poll();
    Statement call();
    void add_function();

    /// A place in a device: how it is written, and what its access is.
    struct Place {
        std::string text;
        Access access;
        std::function<uint32_t(State&)> offset;
    };
    Place place();

    std::mt19937_64 random_;
    std::vector<Variable> plain_;
    std::vector<Device> devices_;
    std::vector<Statement> functions_;
    std::string definitions_;
    unsigned next_ = 0;
};

Expression Writer::leaf(unsigned bytes) {
    if (below(3) == 0) {
        const uint64_t value = cut(random_() >> below(60), bytes);
        return {fmt::format("(({})0x{:X}u)", type_name(bytes), value),
                [=](State&) { return value; }};
    }
    const Variable variable = plain_[below(static_cast<uint32_t>(plain_.size()))];
    return {fmt::format("({}){}", type_name(bytes), variable.name),
            [=](State& state) { return cut(state.plain[variable.name], bytes); }};
}

/// Unsigned arithmetic, cut to size at every step; no access to the outside.
Expression Writer::expression(unsigned bytes, int depth) {
    if (depth == 0) return leaf(bytes);
    const Expression left = expression(bytes, depth - 1);
    const Expression right = expression(bytes, depth - 1);
    using Apply = uint64_t (*)(uint64_t, uint64_t);
    struct Form {
        const char* text;
        Apply apply;
    };
    static constexpr std::array kForms = {
        Form{"+", [](uint64_t a, uint64_t b) { return a + b; }},
        Form{"-", [](uint64_t a, uint64_t b) { return a - b; }},
        Form{"&", [](uint64_t a, uint64_t b) { return a & b; }},
        Form{"|", [](uint64_t a, uint64_t b) { return a | b; }},
        Form{"^", [](uint64_t a, uint64_t b) { return a ^ b; }},
        Form{"<", [](uint64_t a, uint64_t b) -> uint64_t { return a < b ? 1 : 0; }},
        Form{"==", [](uint64_t a, uint64_t b) -> uint64_t { return a == b ? 1 : 0; }},
    };
    const Form form = kForms[below(kForms.size())];
    return {fmt::format("(({})({} {} {}))", type_name(bytes), left.text, form.text, right.text),
            [=](State& state) {
                const uint64_t a = left.value(state);
                return cut(form.apply(a, right.value(state)), bytes);
            }};
}

Writer::Place Writer::place() {
    const Device device = devices_[below(static_cast<uint32_t>(devices_.size()))];
    const Device::Part part = device.parts[below(static_cast<uint32_t>(device.parts.size()))];
    const Access access{.object = device.name, .bytes = part.bytes};
    if (!part.name.starts_with("[") || below(2) == 0) {
        return {device.name + part.name, access, [=](State&) { return part.offset; }};
    }
    const Expression index = leaf(1);
    return {fmt::format("{}[{} & 3]", device.name, index.text), access, [=](State& state) {
                return static_cast<uint32_t>((index.value(state) & 3) * part.bytes);
            }};
}

Statement Writer::device_statement() {
    const Place where = place();
    const Variable variable = plain_[below(static_cast<uint32_t>(plain_.size()))];
    const unsigned bytes = where.access.bytes;
    const Expression operand = expression(bytes, static_cast<int>(below(3)));
    const auto access = [=](State& state, Access::Kind kind) {
        Access made = where.access;
        made.kind = kind;
        made.offset = where.offset(state);
        return made;
    };
    const auto store = [=](State& state, uint64_t value) {
        Access made = access(state, Access::Kind::write);
        made.value = cut(value, bytes);
        state.accesses.push_back(made);
    };
    const auto fetch = [=](State& state) {
        return state.outside(access(state, Access::Kind::read));
    };
    switch (below(6)) {
        case 0:
            return {fmt::format("{};\n", where.text), [=](State& state) { fetch(state); }};
        case 1:
            return {fmt::format("{} += {};\n", where.text, operand.text), [=](State& state) {
                        const uint64_t more = operand.value(state);
                        store(state, fetch(state) + more);
                    }};
        case 2:
            return {fmt::format("{}++;\n", where.text),
                    [=](State& state) { store(state, fetch(state) + 1); }};
        case 3:
            return {fmt::format("{} = {};\n", where.text, operand.text),
                    [=](State& state) { store(state, operand.value(state)); }};
        default:
            return {
                fmt::format("{} = ({}){};\n", variable.name, type_name(variable.bytes), where.text),
                [=](State& state) {
                    state.plain[variable.name] = cut(fetch(state), variable.bytes);
                }};
    }
}

Statement Writer::port_statement() {
    const unsigned port = 0x40 + below(4);
    const std::string name = fmt::format("port {}", port);
    const Variable variable = plain_[below(2)];
    const Expression operand = expression(1, 1);
    switch (below(5)) {
        case 0:
            return {"__i85_ei();\n",
                    [](State& state) { state.accesses.push_back({.kind = Access::Kind::enable}); }};
        case 1:
            return {"__i85_di();\n", [](State& state) {
                        state.accesses.push_back({.kind = Access::Kind::disable});
                    }};
        case 2:
            return {fmt::format("__i85_out({}, {});\n", port, operand.text), [=](State& state) {
                        const uint64_t value = operand.value(state);
                        state.accesses.push_back(
                            {.kind = Access::Kind::out, .object = name, .value = value});
                    }};
        case 3:
            return {fmt::format("__i85_in({});\n", port), [=](State& state) {
                        state.outside({.kind = Access::Kind::in, .object = name});
                    }};
        default:
            return {fmt::format("{} = __i85_in({});\n", variable.name, port), [=](State& state) {
                        state.plain[variable.name] =
                            state.outside({.kind = Access::Kind::in, .object = name});
                    }};
    }
}

Statement Writer::branch(int depth) {
    const Expression condition = expression(1 + below(2), 2);
    const Statement yes = block(depth - 1, 1 + below(3));
    const Statement no = block(depth - 1, below(3));
    return {fmt::format("if ({}) {{\n{}}} else {{\n{}}}\n", condition.text, yes.text, no.text),
            [=](State& state) {
                if (condition.value(state) != 0) {
                    yes.run(state);
                } else {
                    no.run(state);
                }
            }};
}

Statement Writer::loop(int depth) {
    const unsigned count = 1 + below(5);
    const Statement body = block(depth - 1, 1 + below(3));
    const std::string counter = fmt::format("i{}", next_++);
    return {fmt::format("for (uint8_t {0} = 0; {0} < {1}; ++{0}) {{\n{2}}}\n", counter, count,
                        body.text),
            [=](State& state) {
                for (unsigned i = 0; i < count; ++i) body.run(state);
            }};
}

/// Waits for a bit, for some time.
Statement Writer::poll() {
    const unsigned limit = 2 + below(6);
    const unsigned bit = 1U << below(8);
    const std::string counter = fmt::format("i{}", next_++);
    return {fmt::format("for (uint8_t {0} = 0; {0} < {1}; ++{0}) if (v8 & {2}) break;\n", counter,
                        limit, bit),
            [=](State& state) {
                for (unsigned i = 0; i < limit; ++i) {
                    if ((state.outside({.object = "v8"}) & bit) != 0) break;
                }
            }};
}

Statement Writer::call() {
    if (functions_.empty()) return device_statement();
    return functions_[below(static_cast<uint32_t>(functions_.size()))];
}

Statement Writer::statement(int depth) {
    const uint32_t draw = below(12);
    if (draw < 5) return device_statement();
    if (draw < 7) return port_statement();
    if (draw < 8) return call();
    if (draw < 9) return poll();
    if (draw < 10 && depth > 0) return branch(depth);
    if (draw < 11 && depth > 0) return loop(depth);
    const Variable variable = plain_[below(static_cast<uint32_t>(plain_.size()))];
    const Expression value = expression(variable.bytes, 2);
    return {fmt::format("{} = {};\n", variable.name, value.text),
            [=](State& state) { state.plain[variable.name] = value.value(state); }};
}

Statement Writer::block(int depth, uint32_t statements) {
    Statement made{"", [](State&) {}};
    for (uint32_t i = 0; i < statements; ++i) {
        const Statement next = statement(depth);
        made.text += next.text;
        made.run = [before = made.run, next](State& state) {
            before(state);
            if (state.accesses.size() < kAccessLimit) next.run(state);
        };
    }
    return made;
}

void Writer::add_function() {
    const std::string name = fmt::format("f{}", functions_.size());
    const Statement body = block(2, 2 + below(4));
    definitions_ +=
        fmt::format("{} void {}(void) {{\n{}}}\n",
                    below(2) == 0 ? "static __attribute__((noinline))" : "static", name, body.text);
    functions_.push_back({name + "();\n", body.run});
}

VolatileProgram Writer::make(uint64_t seed) {
    VolatileProgram program;
    State state{.seed = seed, .reads = 0, .plain = {}, .accesses = {}};
    program.text = "#include <i85.h>\n";
    for (const Device& device : devices_) program.text += device.declaration + "\n";
    for (const Variable& variable : plain_) {
        const uint64_t value = cut(random_(), variable.bytes);
        state.plain[variable.name] = value;
        program.text += fmt::format("static {} {} = 0x{:X}u;\n", type_name(variable.bytes),
                                    variable.name, value);
    }
    for (int i = 0; i < 3; ++i) add_function();
    Statement body = block(3, 12);
    std::string ends;
    for (const Variable& variable : plain_) {
        const std::string device = fmt::format("v{}", 8 * variable.bytes);
        ends += fmt::format("{} = {};\n", device, variable.name);
    }
    body.run(state);
    const bool is_short = state.accesses.size() < kAccessLimit;
    if (!is_short) return make_volatile_program(seed + 1'000'000);
    for (const Variable& variable : plain_) {
        state.accesses.push_back({.kind = Access::Kind::write,
                                  .object = fmt::format("v{}", 8 * variable.bytes),
                                  .bytes = variable.bytes,
                                  .value = state.plain[variable.name]});
    }
    program.text += definitions_ + "int main(void) {\n" + body.text + ends + "__i85_hlt();\n}\n";
    program.devices = devices_;
    program.accesses = std::move(state.accesses);
    return program;
}

}  // namespace

std::string Access::text() const {
    switch (kind) {
        case Kind::enable:
            return "EI";
        case Kind::disable:
            return "DI";
        default:
            break;
    }
    static constexpr std::array kNames = {"read", "write", "in", "out"};
    return fmt::format("{} {} + {} ({} bytes): {:X}", kNames[static_cast<std::size_t>(kind)],
                       object, offset, bytes, value);
}

uint64_t outside_value(uint64_t seed, uint64_t index) {
    uint64_t mixed = seed * 0x9E3779B97F4A7C15U + (index + 1) * 0xD1B54A32D192ED03U;
    mixed = (mixed ^ (mixed >> 30)) * 0xBF58476D1CE4E5B9U;
    mixed = (mixed ^ (mixed >> 27)) * 0x94D049BB133111EBU;
    return mixed ^ (mixed >> 31);
}

VolatileProgram make_volatile_program(uint64_t seed) {
    return Writer(seed).make(seed);
}

}  // namespace target_test
