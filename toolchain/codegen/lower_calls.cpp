// lower_calls.cpp - see lower_calls.hpp. Steps: signatures, recursion, narrow routines, places.
#include "toolchain/codegen/lower_calls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "toolchain/codegen/abi.hpp"
#include "toolchain/codegen/builder.hpp"
#include "toolchain/codegen/call_graph.hpp"
#include "toolchain/codegen/known_bytes.hpp"
#include "toolchain/codegen/narrow_calls.hpp"
#include "toolchain/codegen/runtime_abi.hpp"

namespace toolchain::codegen {

namespace {

std::vector<std::size_t> sizes_of(const std::vector<Bytes>& values) {
    std::vector<std::size_t> sizes;
    for (const Bytes& value : values) sizes.push_back(value.size());
    return sizes;
}

/// What a caller and its callee have to agree about.
struct Convention {
    ValuePlaces arguments{};
    ValuePlaces result{};
    std::string arguments_symbol{};
    std::string result_symbol{};
};

Convention convention_of(const std::vector<Bytes>& arguments, std::size_t result_size,
                         bool through_pointer, const std::string& name,
                         const std::string& signature) {
    Convention convention;
    convention.arguments = place_arguments(sizes_of(arguments), through_pointer);
    convention.result = place_result(result_size);
    convention.arguments_symbol =
        through_pointer ? shared_arguments_name(signature) : arguments_name(name);
    convention.result_symbol = through_pointer ? shared_result_name(signature) : result_name(name);
    return convention;
}

// -- Recursion -----------------------------------------------------------------------------------

/// Marks the calls that may come back, and the functions.
void mark_recursion(Module& module) {
    const CallGraph graph(module);
    for (std::size_t index = 0; index < module.functions.size(); ++index) {
        Function& function = module.functions[index];
        function.recursive = graph.is_recursive(index);
        if (!function.recursive) continue;
        const auto comes_back = [&](std::size_t callee) {
            return callee != CallGraph::kNoFunction && graph.group(callee) == graph.group(index);
        };
        for (Block& block : function.blocks) {
            for (Operation& operation : block.operations) {
                if (operation.opcode == Opcode::call) {
                    operation.reenters = comes_back(graph.index_of(operation.symbol));
                } else if (operation.opcode == Opcode::call_indirect) {
                    for (const std::size_t callee : graph.targets(operation.signature)) {
                        operation.reenters = operation.reenters || comes_back(callee);
                    }
                }
            }
        }
    }
}

/// Moves the variables of a recursive function from its frame to the stack. An address is computed
/// right before each operation that uses it: it costs two instructions and no register meanwhile.
class StackVariables {
public:
    explicit StackVariables(Function& function) : function_(function) {
        for (const FrameObject& object : function.frame) {
            // SP is even, so that is as far as alignment can go.
            uint32_t& bytes = function.stack_bytes;
            if (object.alignment > 1) bytes += bytes % 2;
            offsets_[object.symbol] = bytes;
            bytes += object.size;
        }
        function.stack_bytes += function.stack_bytes % 2;
        function.frame.clear();
    }

    void run() {
        if (offsets_.empty()) return;
        for (Block& block : function_.blocks) {
            std::vector<Operation> operations = std::exchange(block.operations, {});
            for (Operation& operation : operations) {
                addresses_.clear();
                replace(block, operation.left);
                replace(block, operation.right);
                for (Bytes& argument : operation.arguments) replace(block, argument);
                block.operations.push_back(std::move(operation));
            }
            addresses_.clear();
            replace(block, block.terminator.left);
            replace(block, block.terminator.right);
            for (Edge& edge : block.terminator.edges) replace(block, edge.arguments);
        }
    }

private:
    void replace(Block& block, Bytes& bytes) {
        for (ByteId& byte : bytes) {
            const ByteInfo info = function_.bytes[byte];
            const auto object = offsets_.find(info.symbol);
            if (info.symbol == kNone || object == offsets_.end()) continue;
            const auto offset = object->second + static_cast<uint32_t>(info.offset);
            const Bytes address = address_of(block, offset);
            byte = address[info.kind == ByteInfo::Kind::address_low ? 0 : 1];
        }
    }

    Bytes address_of(Block& block, uint32_t offset) {
        const auto known = addresses_.find(offset);
        if (known != addresses_.end()) return known->second;
        Operation operation;
        operation.opcode = Opcode::stack_address;
        operation.immediate16 = offset;
        for (int i = 0; i < 2; ++i) {
            operation.results.push_back(static_cast<ByteId>(function_.bytes.size()));
            function_.bytes.push_back({.kind = ByteInfo::Kind::computed});
        }
        block.operations.push_back(operation);
        addresses_[offset] = operation.results;
        return operation.results;
    }

    Function& function_;
    std::map<SymbolId, uint32_t> offsets_;
    std::map<uint32_t, Bytes> addresses_;  ///< computed before the operation at hand
};

// -- Places --------------------------------------------------------------------------------------

/// Rewrites one function: its entry, its returns, its calls.
class Places {
public:
    Places(Module& module, const std::map<SymbolId, std::size_t>& functions, Function& function)
        : module_(module),
          functions_(functions),
          function_(function),
          demanded_(demanded_bytes(module, function)),
          builder_(function) {}

    void run() {
        convention_ = convention_of(
            function_.parameters, function_.result_size, function_.address_taken,
            module_.symbols[function_.symbol],
            function_.address_taken ? module_.symbols[function_.signature] : std::string());
        reserve();
        for (BlockId id = 0; id < function_.blocks.size(); ++id) {
            std::vector<Operation> operations = std::exchange(function_.blocks[id].operations, {});
            builder_.set_block(id);
            if (id == 0) enter();
            for (Operation& operation : operations) visit(std::move(operation));
            if (function_.blocks[id].terminator.kind == Terminator::Kind::give_back) leave(id);
        }
        const bool in_registers = !convention_.result.values[0].registers.empty();
        if (in_registers)
            function_.result_registers = convention_.result.values[0].registers;
        else
            function_.result_size = 0;
    }

private:
    /// Memory for its own arguments and result.
    void reserve() {
        const auto own = [&](const std::string& name, uint32_t size) {
            if (size == 0) return;
            const SymbolId symbol = module_.intern(name);
            if (!is_shared_name(name)) {
                function_.frame.push_back({symbol, size});
            } else {
                add_shared(symbol, size);
            }
        };
        own(convention_.arguments_symbol, convention_.arguments.memory_bytes);
        own(convention_.result_symbol, convention_.result.memory_bytes);
    }

    void add_shared(SymbolId symbol, uint32_t size) {
        for (const Variable& variable : module_.variables) {
            if (variable.symbol == symbol) return;
        }
        Variable variable;
        variable.symbol = symbol;
        variable.size = size;
        module_.variables.push_back(variable);
    }

    void enter() {
        Block& entry = function_.blocks[0];
        entry.parameters.clear();
        entry.parameter_sizes.clear();
        for (std::size_t i = 0; i < function_.parameters.size(); ++i) {
            const Bytes& bytes = function_.parameters[i];
            const ValuePlace& place = convention_.arguments.values[i];
            if (!place.registers.empty()) {
                entry.parameters.insert(entry.parameters.end(), bytes.begin(), bytes.end());
                entry.parameter_sizes.push_back(static_cast<uint32_t>(bytes.size()));
                function_.parameter_registers.insert(function_.parameter_registers.end(),
                                                     place.registers.begin(),
                                                     place.registers.end());
                continue;
            }
            const bool used = std::ranges::any_of(bytes, [&](ByteId b) { return demanded_[b]; });
            for (const ByteId byte : bytes) {
                function_.bytes[byte].kind =
                    used ? ByteInfo::Kind::computed : ByteInfo::Kind::undefined;
            }
            if (used) load_into(bytes, convention_.arguments_symbol, place.offset);
        }
    }

    void leave(BlockId id) {
        Terminator& end = function_.blocks[id].terminator;
        if (end.left.empty() || !convention_.result.values[0].registers.empty()) return;
        builder_.set_place(end.place);
        store_to(end.left, convention_.result_symbol, 0);
        end.left.clear();
    }

    void load_into(const Bytes& results, const std::string& symbol, uint32_t offset) {
        Operation operation;
        operation.opcode = Opcode::load;
        operation.left = builder_.address(module_.intern(symbol), static_cast<int32_t>(offset));
        operation.results = results;
        function_.blocks[builder_.block()].operations.push_back(std::move(operation));
    }

    void store_to(const Bytes& value, const std::string& symbol, uint32_t offset) {
        builder_.store(builder_.address(module_.intern(symbol), static_cast<int32_t>(offset)),
                       value, false);
    }

    void visit(Operation operation) {
        builder_.set_place(operation.place);
        if (operation.opcode == Opcode::call) {
            use_short_copy(operation);
            const auto routine = routine_abi(module_.symbols[operation.symbol]);
            if (routine && !functions_.contains(operation.symbol)) {
                return call_routine(std::move(operation), *routine);
            }
            return call_function(std::move(operation));
        }
        if (operation.opcode == Opcode::call_indirect) return call_pointer(std::move(operation));
        function_.blocks[builder_.block()].operations.push_back(std::move(operation));
    }

    void use_short_copy(Operation& operation) {
        if (module_.symbols[operation.symbol] != "__memcpy") return;
        const Bytes& count = operation.arguments.at(2);
        const ByteInfo& high = function_.bytes[count.at(1)];
        if (high.kind != ByteInfo::Kind::constant || high.constant != 0) return;
        operation.symbol = module_.intern("__memcpy8");
        operation.arguments[2].resize(1);
    }

    void call_function(Operation operation) {
        const auto callee = functions_.find(operation.symbol);
        const Function* known =
            callee == functions_.end() ? nullptr : &module_.functions[callee->second];
        const bool through_pointer = known != nullptr && known->address_taken;
        const Convention convention =
            convention_of(operation.arguments, operation.results.size(), through_pointer,
                          module_.symbols[operation.symbol],
                          through_pointer ? module_.symbols[known->signature] : std::string());
        emit_call(std::move(operation), convention);
    }

    void call_pointer(Operation operation) {
        const std::string signature = module_.symbols[operation.signature];
        const Convention convention =
            convention_of(operation.arguments, operation.results.size(), true, {}, signature);
        if (convention.arguments.memory_bytes != 0) {
            add_shared(module_.intern(convention.arguments_symbol),
                       convention.arguments.memory_bytes);
        }
        if (convention.result.memory_bytes != 0) {
            add_shared(module_.intern(convention.result_symbol), convention.result.memory_bytes);
        }
        const Bytes target = std::exchange(operation.left, {});
        operation.symbol = module_.intern(kCallThroughHl);
        operation.argument_registers = {Register::l, Register::h};
        emit_call(std::move(operation), convention, target);
    }

    /// Stores what does not fit into registers, calls, loads the result.
    void emit_call(Operation operation, const Convention& convention, const Bytes& first = {}) {
        const std::vector<Bytes> arguments = std::exchange(operation.arguments, {first});
        Bytes& flat = operation.arguments[0];
        for (std::size_t i = 0; i < arguments.size(); ++i) {
            const ValuePlace& place = convention.arguments.values[i];
            if (place.registers.empty()) {
                if (!arguments[i].empty()) {
                    store_to(arguments[i], convention.arguments_symbol, place.offset);
                }
                continue;
            }
            flat.insert(flat.end(), arguments[i].begin(), arguments[i].end());
            operation.argument_registers.insert(operation.argument_registers.end(),
                                                place.registers.begin(), place.registers.end());
        }
        Bytes in_memory;
        if (convention.result.values[0].registers.empty()) {
            in_memory = std::exchange(operation.results, {});
        } else {
            operation.result_registers = convention.result.values[0].registers;
        }
        function_.blocks[builder_.block()].operations.push_back(std::move(operation));
        const bool used = std::ranges::any_of(in_memory, [&](ByteId b) { return demanded_[b]; });
        if (used) {
            load_into(in_memory, convention.result_symbol, 0);
        } else {
            for (const ByteId byte : in_memory) {
                function_.bytes[byte].kind = ByteInfo::Kind::undefined;
            }
        }
    }

    // -- Runtime routines ------------------------------------------------------------------------

    /// Neighbours in a cell go there together.
    template <typename Move>
    void move_cells(const Bytes& values, const std::vector<RoutineByte>& places, Move move) {
        for (std::size_t i = 0; i < values.size();) {
            if (places[i].where != Register::flags) {
                ++i;
                continue;
            }
            Bytes run;
            const RoutineByte& first = places[i];
            while (i < values.size() && places[i].cell == first.cell &&
                   places[i].where == Register::flags) {
                run.push_back(values[i++]);
            }
            move(run, first);
        }
    }

    void call_routine(Operation operation, const RoutineAbi& abi) {
        Bytes all;
        for (const Bytes& argument : std::exchange(operation.arguments, {{}})) {
            all.insert(all.end(), argument.begin(), argument.end());
        }
        const Bytes results = std::exchange(operation.results, {});
        if (all.size() != abi.arguments.size() || results.size() > abi.results.size()) {
            throw std::logic_error(fmt::format("call of {} with {} and {} bytes",
                                               module_.symbols[operation.symbol], all.size(),
                                               results.size()));
        }
        move_cells(all, abi.arguments, [&](const Bytes& bytes, const RoutineByte& to) {
            store_to(bytes, to.cell, to.offset);
        });
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (abi.arguments[i].where == Register::flags) continue;
            operation.arguments[0].push_back(all[i]);
            operation.argument_registers.push_back(abi.arguments[i].where);
        }
        for (std::size_t i = 0; i < results.size(); ++i) {
            if (abi.results[i].where == Register::flags) continue;
            operation.results.push_back(results[i]);
            operation.result_registers.push_back(abi.results[i].where);
        }
        operation.clobbers = abi.clobbers;
        function_.blocks[builder_.block()].operations.push_back(std::move(operation));
        move_cells(results, abi.results, [&](const Bytes& bytes, const RoutineByte& from) {
            const bool used = std::ranges::any_of(bytes, [&](ByteId b) { return demanded_[b]; });
            if (used) return load_into(bytes, from.cell, from.offset);
            for (const ByteId byte : bytes) {
                function_.bytes[byte].kind = ByteInfo::Kind::undefined;
            }
        });
    }

    Module& module_;
    const std::map<SymbolId, std::size_t>& functions_;
    Function& function_;
    const std::vector<bool> demanded_;
    Builder builder_;
    Convention convention_;
};

bool has_table(const Module& module) {
    for (const Function& function : module.functions) {
        for (const Block& block : function.blocks) {
            if (block.terminator.kind == Terminator::Kind::table) return true;
        }
    }
    return false;
}

}  // namespace

void lower_calls(Module& module, bool narrow) {
    mark_signatures(module);
    mark_recursion(module);
    std::map<SymbolId, std::size_t> functions;
    for (std::size_t i = 0; i < module.functions.size(); ++i) {
        functions[module.functions[i].symbol] = i;
    }
    for (Function& function : module.functions) {
        if (narrow) narrow_calls(module, function);
        if (function.recursive) StackVariables(function).run();
    }
    for (Function& function : module.functions) Places(module, functions, function).run();
    if (has_table(module)) (void)module.intern("__jumpindex");  // generate() refers to it
}

}  // namespace toolchain::codegen
