// Which functions run before main, and in which order. Source: LLVM's reference manual, "The
// 'llvm.global_ctors' Global Variable".
#include "toolchain/ir/constructors.hpp"

#include <gtest/gtest.h>

#include "tests/toolchain/ir/ir_program.hpp"

namespace {

using Names = std::vector<std::string>;

Names names_of(const std::string& list) {
    const auto module = ir_test::to_mir(list + R"(
        define void @a() { ret void }
        define void @b() { ret void }
        define void @c() { ret void })");
    Names names;
    for (const auto symbol : module.constructors) names.push_back(module.symbols[symbol]);
    return names;
}

TEST(Constructors, AreSortedByPriorityAndOtherwiseStayInOrder) {
    EXPECT_EQ(names_of(R"(
        @llvm.global_ctors = appending global [3 x { i32, ptr, ptr }] [
            { i32, ptr, ptr } { i32 65535, ptr @b, ptr null },
            { i32, ptr, ptr } { i32 65535, ptr @a, ptr null },
            { i32, ptr, ptr } { i32 101, ptr @c, ptr null }])"),
              (Names{"c", "b", "a"}));
}

TEST(Constructors, MayBeAbsent) {
    EXPECT_EQ(names_of(""), Names{});
    EXPECT_EQ(names_of("@llvm.global_ctors = appending global [0 x { i32, ptr, ptr }] "
                       "zeroinitializer"),
              Names{});
}

TEST(Constructors, EndAtNull) {
    EXPECT_EQ(names_of(R"(
        @llvm.global_ctors = appending global [2 x { i32, ptr, ptr }] [
            { i32, ptr, ptr } { i32 65535, ptr @a, ptr null },
            { i32, ptr, ptr } { i32 65535, ptr null, ptr null }])"),
              Names{"a"});
}

}  // namespace
