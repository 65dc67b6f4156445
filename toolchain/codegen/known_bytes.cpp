// known_bytes.cpp - see known_bytes.hpp.
#include "toolchain/codegen/known_bytes.hpp"

#include <algorithm>
#include <string>

namespace toolchain::codegen {

namespace {

constexpr uint8_t kSign = 0x80;
/// Second halves of the questions about one byte; no byte has these numbers.
constexpr ByteId kIsZero = kNone;
constexpr ByteId kIsNotNegative = kNone - 1;

bool computes_only(const Module& module, const Operation& operation) {
    switch (operation.opcode) {
        case Opcode::load:
            return !operation.is_volatile;
        case Opcode::call:
            return is_arithmetic_routine(module.symbols[operation.symbol]);
        case Opcode::store:
        case Opcode::call_indirect:
        case Opcode::port_in:
        case Opcode::port_out:
        case Opcode::enable_interrupts:
        case Opcode::disable_interrupts:
        case Opcode::halt:
        case Opcode::read_mask:
        case Opcode::set_mask:
        case Opcode::no_operation:
            return false;
        default:
            return true;
    }
}

/// Marks what is needed, from what has effects back to what it is computed from.
class Demand {
public:
    Demand(const Module& module, const Function& function)
        : module_(module), function_(function), demanded_(function.bytes.size()) {
        definition_.resize(function.bytes.size());
        for (const Block& block : function.blocks) add_definitions(block);
    }

    std::vector<bool> run() {
        for (const Block& block : function_.blocks) {
            for (const Operation& operation : block.operations) {
                if (!computes_only(module_, operation)) all_operands(operation);
            }
            all(block.terminator.left);
            all(block.terminator.right);
        }
        while (!open_.empty()) {
            const ByteId byte = open_.back();
            open_.pop_back();
            follow(byte);
        }
        return std::move(demanded_);
    }

private:
    struct Definition {
        const Operation* operation = nullptr;
        std::size_t index = 0;
        Bytes incoming{};  ///< of a block's parameter
    };

    void add_definitions(const Block& block) {
        for (const Operation& operation : block.operations) {
            for (std::size_t i = 0; i < operation.results.size(); ++i) {
                definition_[operation.results[i]].operation = &operation;
                definition_[operation.results[i]].index = i;
            }
        }
        for (const Edge& edge : block.terminator.edges) {
            const Bytes& parameters = function_.blocks[edge.target].parameters;
            for (std::size_t i = 0; i < parameters.size(); ++i) {
                definition_[parameters[i]].incoming.push_back(edge.arguments[i]);
            }
        }
    }

    void one(ByteId byte) {
        if (demanded_[byte]) return;
        demanded_[byte] = true;
        open_.push_back(byte);
    }
    void all(const Bytes& bytes) {
        for (const ByteId byte : bytes) one(byte);
    }
    void all_operands(const Operation& operation) {
        all(operation.left);
        all(operation.right);
        for (const Bytes& argument : operation.arguments) all(argument);
    }
    void up_to(const Bytes& bytes, std::size_t last) {
        for (std::size_t i = 0; i < std::min(last + 1, bytes.size()); ++i) one(bytes[i]);
    }

    void follow(ByteId byte) {
        const Definition& definition = definition_[byte];
        all(definition.incoming);
        if (definition.operation == nullptr) return;
        const Operation& operation = *definition.operation;
        const std::size_t index = definition.index;
        switch (operation.opcode) {
            case Opcode::add:
            case Opcode::subtract:
                up_to(operation.left, index);
                up_to(operation.right, index);
                break;
            case Opcode::shift_left:
                one(operation.left[index]);
                if (index > 0) one(operation.left[index - 1]);
                break;
            case Opcode::shift_right:
            case Opcode::shift_right_signed:
                one(operation.left[index]);
                if (index + 1 < operation.left.size()) one(operation.left[index + 1]);
                break;
            case Opcode::call:
                follow_call(operation, index);
                break;
            default:
                all_operands(operation);
        }
    }

    // The low bytes of a product, or of a value shifted left, need no higher bytes.
    void follow_call(const Operation& operation, std::size_t index) {
        const std::string& name = module_.symbols[operation.symbol];
        if (!is_arithmetic_routine(name)) return;
        if (name.find("mul") != std::string::npos) {
            for (const Bytes& argument : operation.arguments) up_to(argument, index);
        } else if (name.starts_with("__shl")) {
            up_to(operation.arguments[0], index);
            all(operation.arguments[1]);
        } else {
            all_operands(operation);
        }
    }

    const Module& module_;
    const Function& function_;
    std::vector<bool> demanded_;
    std::vector<Definition> definition_;
    std::vector<ByteId> open_;
};

}  // namespace

bool is_arithmetic_routine(const std::string& name) {
    for (const char* start :
         {"__mul", "__umul", "__smul", "__udiv", "__sdiv", "__shl", "__lshr", "__ashr"}) {
        const std::size_t length = std::string_view(start).size();
        if (name.starts_with(start) && name.size() > length && name[length] >= '0' &&
            name[length] <= '9') {
            return true;
        }
    }
    return false;
}

std::vector<bool> demanded_bytes(const Module& module, const Function& function) {
    return Demand(module, function).run();
}

KnownBytes::KnownBytes(const Function& function)
    : function_(function), origins_(function.bytes.size()), edges_(function.blocks.size()) {
    for (BlockId id = 0; id < function.blocks.size(); ++id) {
        const Block& block = function.blocks[id];
        for (std::size_t i = 0; i < block.parameters.size(); ++i) {
            origins_[block.parameters[i]] = {nullptr, id, i};
        }
        for (const Operation& operation : block.operations) {
            for (std::size_t i = 0; i < operation.results.size(); ++i) {
                origins_[operation.results[i]] = {&operation, kNone, i};
            }
        }
        for (const Edge& edge : block.terminator.edges) edges_[edge.target].push_back(&edge);
    }
}

template <typename Ask>
bool KnownBytes::for_all_edges(Question question, const Origin& origin, Ask ask) {
    if (origin.block == 0 || origin.block == kNone) return false;
    if (assumed_.contains(question)) return true;
    // What was answered below a question rests on it: with a no, or at the end, it is forgotten.
    const std::set<Question> before = assumed_;
    assumed_.insert(question);
    const bool holds =
        std::ranges::all_of(edges_[origin.block], [&](const Edge* edge) { return ask(*edge); });
    if (!holds || before.empty()) assumed_ = before;
    return holds;
}

bool KnownBytes::is_constant(ByteId byte, uint8_t value) {
    const ByteInfo& info = function_.bytes[byte];
    if (info.kind == ByteInfo::Kind::constant) return info.constant == value;
    if (info.kind != ByteInfo::Kind::parameter || value != 0) return false;
    const Origin origin = origins_[byte];
    return for_all_edges({byte, kIsZero}, origin, [&](const Edge& edge) {
        return is_constant(edge.arguments[origin.index], 0);
    });
}

bool KnownBytes::is_not_negative(ByteId byte) {
    const ByteInfo& info = function_.bytes[byte];
    if (info.kind == ByteInfo::Kind::constant) return (info.constant & kSign) == 0;
    const Origin origin = origins_[byte];
    if (info.kind == ByteInfo::Kind::parameter) {
        return for_all_edges({byte, kIsNotNegative}, origin, [&](const Edge& edge) {
            return is_not_negative(edge.arguments[origin.index]);
        });
    }
    if (info.kind != ByteInfo::Kind::computed || origin.operation == nullptr) return false;
    const Operation& operation = *origin.operation;
    switch (operation.opcode) {
        case Opcode::compare:
            return true;
        case Opcode::bit_and:
            return is_not_negative(operation.left[0]) || is_not_negative(operation.right[0]);
        case Opcode::bit_or:
        case Opcode::bit_xor:
            return is_not_negative(operation.left[0]) && is_not_negative(operation.right[0]);
        case Opcode::shift_right:
            return origin.index + 1 == operation.results.size();
        case Opcode::shift_right_signed:
            return origin.index + 1 == operation.results.size() &&
                   is_not_negative(operation.left.back());
        case Opcode::sign_fill:
            return is_not_negative(operation.left[0]);
        default:
            return false;
    }
}

bool KnownBytes::is_sign_of(ByteId byte, ByteId of) {
    const ByteInfo& info = function_.bytes[byte];
    if (info.kind == ByteInfo::Kind::constant) {
        if (info.constant == 0) return is_not_negative(of);
        const ByteInfo& other = function_.bytes[of];
        return info.constant == 0xFF && other.kind == ByteInfo::Kind::constant &&
               (other.constant & kSign) != 0;
    }
    const Origin origin = origins_[byte];
    if (info.kind == ByteInfo::Kind::computed && origin.operation != nullptr &&
        origin.operation->opcode == Opcode::sign_fill) {
        // A sign's sign is itself.
        return byte == of || origin.operation->left[0] == of;
    }
    const Origin other = origins_[of];
    if (info.kind != ByteInfo::Kind::parameter || other.block != origin.block) return false;
    return for_all_edges({byte, of}, origin, [&](const Edge& edge) {
        return is_sign_of(edge.arguments[origin.index], edge.arguments[other.index]);
    });
}

std::size_t KnownBytes::zero_width(const Bytes& value) {
    std::size_t width = value.size();
    while (width > 0 && is_constant(value[width - 1], 0)) --width;
    return width;
}

std::size_t KnownBytes::sign_width(const Bytes& value) {
    std::size_t width = value.size();
    while (width > 1 && is_sign_of(value[width - 1], value[width - 2])) --width;
    return width;
}

}  // namespace toolchain::codegen
