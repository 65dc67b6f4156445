// longest_path.cpp - see longest_path.hpp.
#include "tools/bounds/longest_path.hpp"

#include <glpk.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "tools/budget/budget_error.hpp"

namespace rover_bounds {
namespace {

/// One row: factors by column, and a constant that belongs to the other side.
struct Row {
    std::map<int, double> factors;
    double constant = 0;

    void add(const Row& other, double factor) {
        for (const auto& [column, value] : other.factors) factors[column] += factor * value;
        constant += factor * other.constant;
    }
};

/// A procedure in the program: columns of its edges begin behind `first_column`.
struct Part {
    const Procedure* procedure = nullptr;
    const std::vector<BoundedLoop>* loops = nullptr;
    int first_column = 0;
    Row entered;  ///< how often it is called
};

class PathProgram {
public:
    PathProgram(const FlowProgram& program, const Procedure& root,
                const std::vector<BoundedLoop>& root_loops, bool is_step)
        : program_(program), root_(root.entry), is_step_(is_step), lp_(glp_create_prob()) {
        glp_set_obj_dir(lp_.get(), GLP_MAX);
        add_part(root, root_loops);
        for (const Edge& edge : root.edges) {
            if (edge.callee) add_called(*edge.callee);
        }
        count_calls();
        for (const auto& [entry, part] : parts_) constrain(part);
        for (const FlowFact& fact : program.table().facts) add_fact(fact);
    }

    std::optional<PathBound> solve() {
        glp_smcp options;
        glp_init_smcp(&options);
        options.msg_lev = GLP_MSG_OFF;
        options.presolve = GLP_ON;
        const int failure = glp_simplex(lp_.get(), &options);
        if (failure == GLP_ENOPFS) return {};
        if (failure != 0 || glp_get_status(lp_.get()) != GLP_OPT) {
            throw std::runtime_error("no longest path of " + parts_.at(root_).procedure->name +
                                     ": GLPK finds no solution");
        }
        return result();
    }

private:
    static constexpr double kTolerance = 1e-6;

    [[nodiscard]] bool is_skipped(uint16_t callee) const {
        return is_step_ && callee == program_.wait();
    }

    void add_called(uint16_t callee) {
        if (is_skipped(callee)) return;
        for (const uint16_t entry : program_.graph().reached_from(callee)) {
            if (!parts_.contains(entry))
                add_part(program_.graph().at(entry), program_.loops(entry));
        }
    }

    void add_part(const Procedure& procedure, const std::vector<BoundedLoop>& loops) {
        Part part{&procedure, &loops, glp_get_num_cols(lp_.get()), {}};
        if (!procedure.stated_t) {
            const auto count = static_cast<int>(procedure.edges.size());
            glp_add_cols(lp_.get(), count);
            for (int i = 1; i <= count; ++i) {
                const Edge& edge = procedure.edges[static_cast<std::size_t>(i - 1)];
                glp_set_col_bnds(lp_.get(), part.first_column + i, GLP_LO, 0, 0);
                glp_set_obj_coef(lp_.get(), part.first_column + i, edge_cost(edge));
            }
        }
        parts_.emplace(procedure.entry, std::move(part));
    }

    [[nodiscard]] double edge_cost(const Edge& edge) const {
        double t = edge.t;
        if (edge.callee && !is_skipped(*edge.callee)) {
            t += program_.graph().at(*edge.callee).stated_t.value_or(0);
        }
        return t;
    }

    static int column(const Part& part, std::size_t edge) {
        return part.first_column + static_cast<int>(edge) + 1;
    }

    void count_calls() {
        parts_.at(root_).entered.constant = 1;
        for (const auto& [entry, part] : parts_) {
            if (part.procedure->stated_t) continue;
            for (std::size_t i = 0; i < part.procedure->edges.size(); ++i) {
                const auto& callee = part.procedure->edges[i].callee;
                if (callee && !is_skipped(*callee)) {
                    parts_.at(*callee).entered.factors[column(part, i)] += 1;
                }
            }
        }
    }

    void constrain(const Part& part) {
        if (part.procedure->stated_t) return;
        std::vector<Row> blocks(part.procedure->blocks.size());
        blocks[0].add(part.entered, 1);
        for (std::size_t i = 0; i < part.procedure->edges.size(); ++i) {
            const Edge& edge = part.procedure->edges[i];
            blocks[edge.from].factors[column(part, i)] -= 1;
            if (edge.to) blocks[*edge.to].factors[column(part, i)] += 1;
        }
        for (const Row& block : blocks) add_row(block, GLP_FX, 0);
        for (const BoundedLoop& loop : *part.loops) {
            Row row = turns(part, loop);
            row.add(entries(part, loop), -static_cast<double>(loop.most));
            add_row(row, GLP_UP, 0);
        }
    }

    [[nodiscard]] static Row entries(const Part& part, const BoundedLoop& loop) {
        Row row;
        if (loop.loop.entered_with_procedure) row = part.entered;
        for (const std::size_t edge : loop.loop.entries) row.factors[column(part, edge)] += 1;
        return row;
    }

    [[nodiscard]] static Row turns(const Part& part, const BoundedLoop& loop) {
        Row row = entries(part, loop);
        for (const std::size_t edge : loop.loop.turns) row.factors[column(part, edge)] += 1;
        return row;
    }

    /// A fact counts calls and turns of a whole step. Below one of the functions that it counts it
    /// says nothing.
    void add_fact(const FlowFact& fact) {
        Row sum;
        for (const FlowTerm& term : fact.terms) {
            for (const auto& [entry, procedure] : program_.graph().procedures) {
                if (!term.item.fits(procedure.name)) continue;
                const auto part = parts_.find(entry);
                if (part == parts_.end()) {
                    if (!is_step_ && program_.graph().reached_from(entry).contains(root_)) return;
                    continue;
                }
                sum.add(count(part->second, term.item), static_cast<double>(term.factor));
            }
        }
        if (!sum.factors.empty()) add_row(sum, GLP_UP, static_cast<double>(fact.most));
    }

    [[nodiscard]] static Row count(const Part& part, const FlowItem& item) {
        if (!item.loop) return part.entered;
        for (const BoundedLoop& loop : *part.loops) {
            if (loop.number == item.loop) return turns(part, loop);
        }
        return {};
    }

    void add_row(const Row& row, int kind, double most) {
        const int index = glp_add_rows(lp_.get(), 1);
        const double bound = most - row.constant;
        glp_set_row_bnds(lp_.get(), index, kind, bound, bound);
        std::vector<int> columns = {0};
        std::vector<double> values = {0};
        for (const auto& [column, value] : row.factors) {
            if (value == 0) continue;
            columns.push_back(column);
            values.push_back(value);
        }
        glp_set_mat_row(lp_.get(), index, static_cast<int>(columns.size()) - 1, columns.data(),
                        values.data());
    }

    [[nodiscard]] PathBound result() const {
        PathBound bound;
        bound.t = static_cast<uint64_t>(std::ceil(glp_get_obj_val(lp_.get()) - kTolerance));
        for (const auto& [entry, part] : parts_) {
            PathShare share;
            share.calls = part.entered.constant;
            for (const auto& [column, value] : part.entered.factors) {
                share.calls += value * glp_get_col_prim(lp_.get(), column);
            }
            share.own_t = share.calls * part.procedure->stated_t.value_or(0);
            for (std::size_t i = 0; i < part.procedure->edges.size(); ++i) {
                if (part.procedure->stated_t) break;
                share.own_t +=
                    glp_get_col_prim(lp_.get(), column(part, i)) * part.procedure->edges[i].t;
            }
            if (share.calls > 0) bound.by[entry] = share;
        }
        return bound;
    }

    struct Free {
        void operator()(glp_prob* lp) const { glp_delete_prob(lp); }
    };

    const FlowProgram& program_;
    uint16_t root_;
    bool is_step_;
    std::unique_ptr<glp_prob, Free> lp_;
    std::map<uint16_t, Part> parts_;
};

/// Is there a loop in it that is never left?
bool has_endless_loop(const FlowProgram& program, uint16_t entry) {
    for (const uint16_t reached : program.graph().reached_from(entry)) {
        for (const BoundedLoop& loop : program.loops(reached)) {
            if (loop.kind == LoopKind::endless) return true;
        }
    }
    return false;
}

[[noreturn]] void refuse(const FlowProgram& program, const std::string& name) {
    throw rover_budget::BudgetError(program.table().file, 0,
                                    "no way through " + name + " agrees with all its facts",
                                    "correct the fact that contradicts the code");
}

}  // namespace

std::optional<PathBound> longest_path(const FlowProgram& program, uint16_t entry) {
    const Procedure& root = program.graph().at(entry);
    if (root.stated_t) {
        return PathBound{*root.stated_t, {{entry, {1, static_cast<double>(*root.stated_t)}}}};
    }
    auto bound = PathProgram(program, root, program.loops(entry), false).solve();
    if (!bound && !has_endless_loop(program, entry)) refuse(program, root.name);
    return bound;
}

PathBound longest_step(const FlowProgram& program) {
    const auto bound = PathProgram(program, program.step(), program.step_loops(), true).solve();
    if (!bound) refuse(program, program.step().name);
    return *bound;
}

}  // namespace rover_bounds
