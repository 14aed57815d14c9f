#include "engine/graph/plan/mutate.h"

#include "engine/core/error.h"

namespace patina::graph {

std::vector<std::string> find_unneeded_barriers(const Description& description, const Plan& plan) {
    const std::vector<std::string> reported = check(description, plan);
    std::vector<std::string> unneeded;
    for (size_t i = 0; i < plan.barriers.size(); ++i) {
        Plan mutant = plan;
        mutant.barriers.erase(mutant.barriers.begin() + static_cast<std::ptrdiff_t>(i));
        if (check(description, mutant) != reported) continue;
        const Barrier& barrier = plan.barriers[i];
        unneeded.push_back(
            text(barrier.resource ? text("the barrier on '", description.resources[*barrier.resource].name, "'")
                                  : std::string("the frame boundary"),
                 " before pass '", description.passes[plan.order[barrier.before]].name, "' is not needed"));
    }
    return unneeded;
}

}  // namespace patina::graph
