// edge.hpp - code between two blocks: everything where the second one expects it.
// Depends on   recipes.hpp.
#pragma once

#include "toolchain/codegen/recipes.hpp"

namespace toolchain::codegen {

/// Appends the moves of an edge. All goals hold afterwards: memory is written first, then
/// registers; where values wait for each other in a circle they go over the stack.
/// @param coder  at the end of the block
void cross(Coder& coder, const Edge& edge, const Contract& target);

}  // namespace toolchain::codegen
