// Modules to one: what is visible, what is missing, what may not be there.
#include "toolchain/driver/join.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <llvm/AsmParser/Parser.h>
#include <llvm/IR/Constants.h>
#include <llvm/IR/Instructions.h>
#include <llvm/Support/SourceMgr.h>

#include "tests/toolchain/driver/compile.hpp"

namespace {

using namespace toolchain::driver;
using driver_test::failure_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

class Join : public testing::Test {
protected:
    ModulePointer parse(const std::string& text, const std::string& name = "a.c") {
        llvm::SMDiagnostic problem;
        ModulePointer module = llvm::parseAssemblyString(text, problem, context_);
        if (!module) throw std::runtime_error(problem.getMessage().str());
        module->setSourceFileName(name);
        return module;
    }
    std::vector<ModulePointer> parse_all(const std::vector<std::string>& texts) {
        std::vector<ModulePointer> modules;
        for (const std::string& text : texts) modules.push_back(parse(text));
        return modules;
    }
    std::string check(const std::string& text, bool allow_constructors = true) {
        const ModulePointer module = parse(text);
        return failure_of([&] { check_whole(*module, allow_constructors); });
    }

private:
    llvm::LLVMContext context_;
};

std::set<std::string> defined_in(const llvm::Module& module) {
    std::set<std::string> names;
    for (const llvm::GlobalValue& value : module.global_values()) {
        if (!value.isDeclaration()) names.insert(value.getName().str());
    }
    return names;
}

TEST_F(Join, ADefinitionMeetsItsUse) {
    const ModulePointer whole =
        parse("declare i16 @f()\ndefine i16 @main() { %r = call i16 @f() ret i16 %r }");
    link_into(*whole, parse("define i16 @f() { ret i16 7 }"));
    EXPECT_THAT(defined_in(*whole), UnorderedElementsAre("main", "f"));
    EXPECT_EQ(failure_of([&] { check_whole(*whole, true); }), "");
}

TEST_F(Join, TwoDefinitionsAreAMistake) {
    const ModulePointer whole = parse("define void @f() { ret void }", "a.c");
    EXPECT_EQ(failure_of([&] { link_into(*whole, parse("define void @f() { ret void }", "b.c")); }),
              "b.c: 'f' is defined in another source too: keep one definition");
}

TEST_F(Join, AWeakDefinitionGivesWay) {
    const ModulePointer whole = parse("define weak i16 @f() { ret i16 1 }");
    link_into(*whole, parse("define i16 @f() { ret i16 2 }"));
    EXPECT_FALSE(whole->getFunction("f")->hasWeakLinkage());
}

TEST_F(Join, OneOfEqualInlineFunctionsIsKept) {
    const std::string text =
        "$f = comdat any\n"
        "define linkonce_odr i16 @f() comdat { ret i16 1 }\n"
        "define i16 @g() { %r = call i16 @f() ret i16 %r }";
    const ModulePointer whole = parse(text);
    link_into(*whole, parse("$f = comdat any\n"
                            "define linkonce_odr i16 @f() comdat { ret i16 1 }\n"
                            "define i16 @h() { %r = call i16 @f() ret i16 %r }"));
    EXPECT_THAT(defined_in(*whole), UnorderedElementsAre("f", "g", "h"));
}

TEST_F(Join, KnowsWhatIsMissing) {
    const auto modules = parse_all(
        {"declare void @a()\ndeclare void @b()\ndeclare void @unused()\n@v = external global i8\n"
         "declare void @llvm.trap()\n"
         "define void @f() { call void @a() call void @b() call void @llvm.trap() ret void }\n"
         "define ptr @g() { ret ptr @v }",
         "define void @b() { ret void }"});
    EXPECT_THAT(missing_names(modules), UnorderedElementsAre("a", "v"));
}

TEST_F(Join, KeepsByEveryFormOfAName) {
    const auto modules =
        parse_all({"define void @_ZN5rover4stepEi(i16 %a) { ret void }\n"
                   "define void @_ZN5rover4stepEc(i8 %a) { ret void }\n"
                   "@count = global i8 0\n@_ZN5rover5stateE = global i8 0"});
    using Names = std::set<std::string>;
    const auto kept = [&](const std::string& name) { return find_kept(modules, {name}); };
    EXPECT_EQ(kept("_ZN5rover4stepEi"), Names{"_ZN5rover4stepEi"});
    EXPECT_EQ(kept("rover::step(char)"), Names{"_ZN5rover4stepEc"});
    EXPECT_EQ(kept("rover::step"), (Names{"_ZN5rover4stepEc", "_ZN5rover4stepEi"}));
    EXPECT_EQ(kept("count"), Names{"count"});
    EXPECT_EQ(kept("rover::state"), Names{"_ZN5rover5stateE"});
    EXPECT_EQ(failure_of([&] { (void)kept("stop"); }),
              "'stop' is to be kept, but no source defines it: check the name");
}

TEST_F(Join, WhatIsKeptIsVisibleThoughStatic) {
    const auto modules = parse_all({"define internal void @step() { ret void }"});
    EXPECT_EQ(find_kept(modules, {"step"}), std::set<std::string>{"step"});
    EXPECT_TRUE(modules[0]->getFunction("step")->hasExternalLinkage());
}

TEST_F(Join, MangledMainIsMain) {
    const ModulePointer module = parse("define i16 @_Z4mainv() { ret i16 0 }");
    settle_main(*module);
    EXPECT_THAT(defined_in(*module), ElementsAre("main"));
}

TEST_F(Join, MainWithParametersGetsZeros) {
    const ModulePointer module = parse("define i16 @main(i16 %n, ptr %v) { ret i16 %n }");
    settle_main(*module);
    const llvm::Function* main = module->getFunction("main");
    ASSERT_NE(main, nullptr);
    EXPECT_TRUE(main->arg_empty());
    const auto& call = llvm::cast<llvm::CallInst>(main->getEntryBlock().front());
    EXPECT_EQ(call.getCalledFunction()->getName(), "main.with_arguments");
    EXPECT_TRUE(llvm::cast<llvm::Constant>(call.getArgOperand(0))->isNullValue());
    EXPECT_TRUE(llvm::cast<llvm::Constant>(call.getArgOperand(1))->isNullValue());
}

TEST_F(Join, OnlyWhatIsReachedStays) {
    const ModulePointer module = parse(
        "define i16 @main() { %r = call i16 @a() ret i16 %r }\n"
        "define i16 @a() { ret i16 1 }\ndefine i16 @unused() { ret i16 1 }\n"
        "define i16 @kept() { ret i16 1 }\n@v = global i8 0\n"
        "define void @tick() \"interrupt\"=\"60\" { ret void }");
    internalise(*module, {"kept"});
    EXPECT_THAT(defined_in(*module), UnorderedElementsAre("main", "a", "kept", "tick"));
    EXPECT_TRUE(module->getFunction("a")->hasInternalLinkage());
    EXPECT_FALSE(module->getFunction("kept")->hasInternalLinkage());
    EXPECT_FALSE(module->getFunction("tick")->hasInternalLinkage());
}

TEST_F(Join, AliasesAreResolved) {
    const ModulePointer module = parse(
        "define i16 @f() { ret i16 1 }\n"
        "@g = alias i16 (), ptr @f\n"
        "define i16 @main() { %r = call i16 @g() ret i16 %r }");
    settle_names(*module);
    EXPECT_EQ(module->alias_size(), 0U);
    const auto& call =
        llvm::cast<llvm::CallInst>(module->getFunction("main")->getEntryBlock().front());
    EXPECT_EQ(call.getCalledFunction(), module->getFunction("f"));
}

TEST_F(Join, AWeakNameThatNobodyDefinesIsNull) {
    const ModulePointer module = parse(
        "@v = extern_weak global i8\n"
        "define ptr @main() { ret ptr @v }");
    settle_names(*module);
    const auto& end = module->getFunction("main")->getEntryBlock().front();
    EXPECT_TRUE(llvm::isa<llvm::ConstantPointerNull>(end.getOperand(0)));
}

TEST_F(Join, UsedNamesAreRoots) {
    const ModulePointer module = parse(
        "@v = global i8 0\n@w = global i8 0\n"
        "define void @tick() \"interrupt\"=\"60\" { ret void }\n"
        "@llvm.used = appending global [1 x ptr] [ptr @v], section \"llvm.metadata\"\n"
        "@llvm.compiler.used = appending global [2 x ptr] [ptr @w, ptr @tick], section "
        "\"llvm.metadata\"");
    EXPECT_THAT(used_names(*module), UnorderedElementsAre("v", "w"));
}

// -- What may not be there -----------------------------------------------------------------------

TEST_F(Join, RefusesVectorsThatAreNone) {
    EXPECT_EQ(check("define void @f() \"interrupt\"=\"3\" { ret void }"),
              "a.c: 'f': the 8085 has no interrupt at 03H: take one of i85.h, such as I85_RST_75");
    EXPECT_EQ(check("define void @f() \"interrupt\"=\"0\" { ret void }"),
              "a.c: 'f': the 8085 has no interrupt at 00H: take one of i85.h, such as I85_RST_75");
    for (const char* vector : {"36", "44", "52", "60", "8", "56"}) {
        EXPECT_EQ(
            check("define void @f() \"interrupt\"=\"" + std::string(vector) + "\" { ret void }"),
            "");
    }
}

TEST_F(Join, RefusesTwoFunctionsForOneVector) {
    EXPECT_EQ(check("define void @f() \"interrupt\"=\"60\" { ret void }\n"
                    "define void @g() \"interrupt\"=\"60\" { ret void }"),
              "a.c: 'f' and 'g' both serve the interrupt at 3CH: keep one");
}

TEST_F(Join, RefusesCallsOfInterruptFunctions) {
    EXPECT_EQ(check("define void @f() \"interrupt\"=\"60\" { ret void }\n"
                    "define void @main() { call void @f() ret void }"),
              "a.c: the interrupt function 'f' is called: call a function that both share");
}

TEST_F(Join, RefusesCallsThatDoNotFit) {
    EXPECT_EQ(check("define void @f(i16 %a) { ret void }\n"
                    "define void @main() { call void @f() ret void }"),
              "a.c: 'f' is called with other parameters or another result than it is defined "
              "with: declare it as it is");
}

TEST_F(Join, RefusesAssemblyOutsideOfFunctions) {
    EXPECT_EQ(check("module asm \"nop\""),
              "a.c: assembly outside of functions is not supported: use i85.h");
}

TEST_F(Join, RefusesSections) {
    EXPECT_EQ(check("@v = global i8 0, section \".noinit\""),
              "a.c: 'v' is to be in section '.noinit', but sections have no names here: leave the "
              "attribute out");
}

TEST_F(Join, NamesWhatIsNotDefinedAndWhy) {
    EXPECT_EQ(check("declare void @f()\ndefine void @main() { call void @f() ret void }"),
              "a.c: 'f' is used but not defined: add the source that defines it, or correct the "
              "name");
    EXPECT_THAT(check("declare ptr @malloc(i16)\n"
                      "define ptr @main() { %r = call ptr @malloc(i16 2) ret ptr %r }"),
                HasSubstr("'malloc' is used but not defined: there is no heap"));
    EXPECT_THAT(
        check("declare ptr @_Znwj(i16)\n"
              "define ptr @main() { %r = call ptr @_Znwj(i16 2) ret ptr %r }"),
        HasSubstr("'operator new(unsigned int)' is used but not defined: there is no heap"));
    EXPECT_EQ(check("@v = external global i8\n@p = global ptr @v"),
              "a.c: in 'p': 'v' is used but not defined: add the source that defines it, or "
              "correct the name");
}

TEST_F(Join, ShowsTheFirstTenMistakes) {
    std::string text = "define void @main() {\n";
    std::string declarations;
    for (int i = 0; i < 12; ++i) {
        declarations += "declare void @f" + std::to_string(i) + "()\n";
        text += "call void @f" + std::to_string(i) + "()\n";
    }
    const std::string failure = check(declarations + text + "ret void }");
    EXPECT_THAT(failure, HasSubstr("'f9'"));
    EXPECT_THAT(failure, testing::Not(HasSubstr("'f10'")));
    EXPECT_THAT(failure, testing::EndsWith("\nand 2 more"));
}

TEST_F(Join, ConstructorsCanBeForbidden) {
    const std::string text =
        "@v = global i8 0\n"
        "define internal void @make() { store i8 1, ptr @v ret void }\n"
        "@llvm.global_ctors = appending global [1 x { i32, ptr, ptr }] "
        "[{ i32, ptr, ptr } { i32 65535, ptr @make, ptr null }]";
    EXPECT_EQ(check(text, true), "");
    EXPECT_EQ(check(text, false),
              "a.c: 'v' is constructed at run time, and --no-constructors forbids it: make it "
              "constinit");
}

}  // namespace
