// Appends to lists that an indirect dispatch of kRecordGroup items a group goes through: word 0 of a list counts its
// entries; the dispatch's arguments start as 1 group, which finds the list empty if it is.
#ifndef PATINA_LIB_RECORD_LIST_GLSL
#define PATINA_LIB_RECORD_LIST_GLSL

#define APPEND_RECORD(list, list_arguments, record)                                              \
    {                                                                                            \
        const uint item_ = atomicAdd(list[0], 1u);                                               \
        list[1u + item_] = record;                                                               \
        if (item_ % kRecordGroup == 0u) atomicMax(list_arguments[0], item_ / kRecordGroup + 1u); \
    }

#endif
