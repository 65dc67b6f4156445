// compare.cpp - see compare.hpp.
#include "tests/toolchain/csmith/compare.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "tests/toolchain/csmith/process.hpp"

namespace csmith_test {

namespace {

constexpr std::size_t kLongestText = 600;

Verdict judge(const Observation& ours, const Observation& oracle) {
    switch (ours.kind) {
        case Observation::Kind::checksum:
            return ours.checksum == oracle.checksum ? Verdict::agreed : Verdict::difference;
        case Observation::Kind::no_end:
            return Verdict::no_end;
        case Observation::Kind::refused:
            return Verdict::refused;
        case Observation::Kind::too_large:
            return Verdict::too_large;
        default:
            return Verdict::failed;
    }
}

std::string one_line(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    if (text.size() > kLongestText) text.resize(kLongestText);
    return text;
}

/// With these a program stops where C leaves its behaviour open: the sanitizer's trap is a loop.
constexpr std::array<const char*, 2> kStopWhenUndefined = {
    "-fsanitize=signed-integer-overflow,shift,integer-divide-by-zero,bounds,null,bool,unreachable",
    "-fsanitize-trap=all"};

/// Whether a difference is ours: avr-gcc says the same at other levels, and C says what happens.
bool is_sure(const Program& program, const Observation& oracle) {
    if (observe_avr(program, "0") != oracle || observe_avr(program, "s") != oracle) return false;
    Program checked = program;
    checked.options.insert(checked.options.end(), kStopWhenUndefined.begin(),
                           kStopWhenUndefined.end());
    SubjectOptions options;
    options.level = "0";
    return observe_subject(checked, Layer::mir, options).kind != Observation::Kind::no_end;
}

}  // namespace

std::string_view name_of(Verdict verdict) {
    constexpr std::array<std::string_view, kVerdicts> names = {
        "agreed", "skipped", "doubtful", "too large", "no end", "refused", "failed", "difference"};
    return names.at(static_cast<std::size_t>(verdict));
}

Finding compare(const Program& program, const CompareOptions& options) {
    const Observation oracle = observe_avr(program);
    if (oracle.kind != Observation::Kind::checksum)
        return {Verdict::skipped, one_line("avr " + to_text(oracle))};
    Finding worst;
    std::vector<std::string> texts;
    for (const std::string& level : options.levels) {
        SubjectOptions subject = options.subject;
        subject.level = level;
        const Observation ours = observe_subject(program, options.layer, subject);
        const Verdict verdict = judge(ours, oracle);
        if (verdict == Verdict::agreed) continue;
        texts.push_back(fmt::format("-O{}: {}", level, to_text(ours)));
        if (options.layer == Layer::image && verdict != Verdict::too_large &&
            verdict != Verdict::refused) {
            const Observation mir = observe_subject(program, Layer::mir, subject);
            texts.back() += mir == oracle ? " (code generation: right in MIR)"
                                          : fmt::format(" (front half: {} in MIR)", to_text(mir));
        }
        worst.verdict = std::max(worst.verdict, verdict);
    }
    if (worst.verdict == Verdict::difference && !is_sure(program, oracle))
        worst.verdict = Verdict::doubtful;
    if (worst.verdict != Verdict::agreed) {
        worst.text = one_line(fmt::format("avr {}, {}", to_text(oracle), fmt::join(texts, "; ")));
    }
    return worst;
}

Finding compare_seed(uint64_t seed, const CompareOptions& options) {
    const WorkFolder folder;
    const auto program = generate(seed, folder.path(), options.kind);
    if (!program) return {Verdict::skipped, "csmith finds no program in time"};
    Finding result = compare(*program, options);
    const bool wanted = is_fault(result.verdict) || result.verdict == Verdict::doubtful;
    if (wanted && !options.keep.empty()) {
        std::filesystem::create_directories(options.keep);
        std::filesystem::copy(program->source, options.keep / program->source.filename(),
                              std::filesystem::copy_options::overwrite_existing);
    }
    return result;
}

}  // namespace csmith_test
