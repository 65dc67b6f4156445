// recipes.cpp - picks the recipes of an operation.
#include "toolchain/codegen/recipes.hpp"

#include <stdexcept>

namespace toolchain::codegen {

Ways translate(const Coder& start, const Operation& operation, const RecipeContext& context) {
    Ways ways;
    switch (operation.opcode) {
        case Opcode::add:
        case Opcode::subtract:
            add_sums(ways, start, operation, context);
            break;
        case Opcode::bit_and:
        case Opcode::bit_or:
        case Opcode::bit_xor:
            add_logic(ways, start, operation);
            break;
        case Opcode::shift_left:
        case Opcode::shift_right:
        case Opcode::shift_right_signed:
        case Opcode::sign_fill:
            add_shifts(ways, start, operation);
            break;
        case Opcode::compare:
            add_compare(ways, start, operation, context);
            break;
        case Opcode::load:
            add_loads(ways, start, operation);
            break;
        case Opcode::store:
            add_stores(ways, start, operation);
            break;
        default:
            add_calls(ways, start, operation, context);
            break;
    }
    return ways;
}

}  // namespace toolchain::codegen
