// The representation: symbols, text, and what the verifier finds.
#include "toolchain/codegen/mir.hpp"

#include <gtest/gtest.h>

#include "toolchain/codegen/builder.hpp"

namespace {

using namespace toolchain::codegen;

TEST(Mir, SymbolsAreInternedOnce) {
    Module module;
    const SymbolId first = module.intern("a");
    EXPECT_EQ(module.intern("b"), first + 1);
    EXPECT_EQ(module.intern("a"), first);
    EXPECT_EQ(module.symbols[first], "a");
    EXPECT_EQ(module.find(first), nullptr);
}

TEST(Mir, PredicatesInvert) {
    EXPECT_EQ(inverse(Predicate::equal), Predicate::not_equal);
    EXPECT_EQ(inverse(Predicate::not_below), Predicate::below);
    EXPECT_EQ(inverse(Predicate::less), Predicate::not_less);
}

class MirFunction : public testing::Test {
protected:
    Module module;
    Function function;
    Builder builder{function};
    Bytes x;

    void SetUp() override {
        function.symbol = module.intern("twice");
        function.result_size = 1;
        function.blocks.emplace_back();
        x = builder.parameter(1);
        function.blocks[0].parameters = x;
        Terminator end;
        end.kind = Terminator::Kind::give_back;
        end.left = builder.add(x, x);
        builder.terminate(end);
    }
};

TEST_F(MirFunction, IsPrinted) {
    EXPECT_EQ(print(module, function),
              "function twice\n  0[b0]:\n    [b1] = add [b0] [b0]\n    return [b1]\n");
}

TEST_F(MirFunction, IsAccepted) {
    EXPECT_EQ(verify(function), "");
}

TEST_F(MirFunction, UseBeforeDefinitionIsFound) {
    std::swap(function.blocks[0].operations[0].left, function.blocks[0].operations[0].results);
    EXPECT_NE(verify(function), "");
}

TEST_F(MirFunction, SizesThatDoNotFitAreFound) {
    function.blocks[0].operations[0].right.clear();
    EXPECT_EQ(verify(function), "block 0: an operation whose sizes do not fit");
}

TEST_F(MirFunction, DefinitionOnOneOfTwoWaysIsNotEnough) {
    // 0 branches to 1 or 2, 1 defines a byte and goes to 2, which uses it.
    function.blocks.resize(3);
    const Bytes sum = function.blocks[0].operations[0].results;
    function.blocks[1].operations = std::exchange(function.blocks[0].operations, {});
    function.blocks[1].terminator.kind = Terminator::Kind::jump;
    function.blocks[1].terminator.edges = {{2, {}}};
    function.blocks[2].terminator = function.blocks[0].terminator;
    Terminator& branch = function.blocks[0].terminator;
    branch = {};
    branch.kind = Terminator::Kind::branch;
    branch.left = x;
    branch.right = x;
    branch.edges = {{1, {}}, {2, {}}};
    EXPECT_EQ(verify(function), "block 2: b1 is used where it is not defined");
}

TEST_F(MirFunction, EdgesMustFitTheirTarget) {
    function.blocks.emplace_back();
    Terminator& end = function.blocks[0].terminator;
    end.kind = Terminator::Kind::jump;
    end.edges = {{0, x}};
    EXPECT_EQ(verify(function), "block 0: an edge to the entry or to nowhere");
    end.edges = {{1, x}};
    EXPECT_EQ(verify(function), "block 0: an edge with the wrong number of arguments");
}

}  // namespace
