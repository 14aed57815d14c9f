#include "engine/core/error.h"
#include "engine/graph/plan/plan.h"

namespace patina::graph {

Scope scope_of(Use use) {
    switch (use) {
        case Use::kStorageRead: return {kStageCompute, kAccessStorageRead};
        case Use::kStorageWrite: return {kStageCompute, kAccessStorageWrite};
        case Use::kStorageReadWrite: return {kStageCompute, kAccessStorageRead | kAccessStorageWrite};
        case Use::kSampled: return {kStageCompute, kAccessSampledRead};
        case Use::kUniform: return {kStageCompute, kAccessUniformRead};
        case Use::kIndirect: return {kStageIndirect, kAccessIndirectRead};
        case Use::kTransferRead: return {kStageTransfer, kAccessTransferRead};
        case Use::kTransferWrite:
        case Use::kTransferModify: return {kStageTransfer, kAccessTransferWrite};
    }
    PATINA_ASSERT(false, "unknown use ", static_cast<int>(use));
    return {};
}

}  // namespace patina::graph
