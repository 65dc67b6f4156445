// Names that the assembler takes, all different.
#include "toolchain/codegen/names.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace {

using namespace toolchain::codegen;

TEST(Names, PlainOnesStay) {
    Module module;
    for (const char* name : {"main", "_Z4stepi", "f.x", "f@args", "a?b", "__mul8"}) {
        const SymbolId symbol = module.intern(name);
        EXPECT_EQ(SafeNames(module).of(symbol), name);
    }
}

TEST(Names, OthersAreMadeSoAndStayDifferent) {
    Module module;
    std::set<std::string> safe;
    for (const char* name : {".str", "_.str", "?x", "_?x", "a b", "a-b", "a_b", "9lives", ""}) {
        module.intern(name);
    }
    const SafeNames names(module);
    for (SymbolId symbol = 0; symbol < module.symbols.size(); ++symbol) {
        const std::string& name = names.of(symbol);
        EXPECT_TRUE(safe.insert(name).second) << name;
        ASSERT_FALSE(name.empty());
        EXPECT_EQ(std::string(".?0123456789").find(name[0]), std::string::npos) << name;
        EXPECT_EQ(name.find_first_of(" -"), std::string::npos) << name;
    }
    EXPECT_EQ(names.of(1), "_.str");  // who has a good name keeps it
    EXPECT_EQ(names.of(0), "_.str@2");
}

TEST(Names, CppNamesAreDemangled) {
    EXPECT_EQ(demangled("_Z4stepi"), "step(int)");
    EXPECT_EQ(demangled("main"), "");
    EXPECT_EQ(demangled("_Zzz"), "");
}

}  // namespace
