/* macro_names.c: what the materials of a model are called in GLSL. */
#include "glsl/macro_names.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/sort.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* A material, COUNT, or a material once more. */
typedef struct named {
    const char *name;
    int plain;   /* 1: the macro is the name in capitals, nothing else changed */
    int settled; /* 0: others have the same macro */
    int listed;  /* 1: the scene has it already */
    hnbrdf_macro_name macro;
} named;

/* A hash set of macros. Free slots hold NULL, `slots` is a power of two above their number. */
typedef struct macro_set {
    named **table;
    size_t slots;
} macro_set;

/* ---- The macro of one name ------------------------------------------------------------------- */

static char capital(char c)
{
    return c >= 'a' && c <= 'z' ? (char)(c - 'a' + 'A') : c;
}

/* Letters, digits and single underscores, which GLSL does not reserve; at least one character. */
static void sanitise(const char *name, hnbrdf_macro_name text)
{
    size_t length = 0;
    for (; *name; name++) {
        const char c = capital(*name);
        if ((c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'))
            text[length++] = c;
        else if (length > 0 && text[length - 1] != '_')
            text[length++] = '_';
    }
    while (length > 0 && text[length - 1] == '_')
        length--;
    if (length == 0)
        text[length++] = 'X';
    text[length] = '\0';
}

static int only_capitals_differ(const char *name, const char *macro)
{
    while (*name && capital(*name) == *macro) {
        name++;
        macro++;
    }
    return *name == *macro; /* both at their end */
}

/* ---- Distinct macros ------------------------------------------------------------------------- */

/* The slot of this macro: free or held by one that has the same. */
static named **slot_of(const macro_set *set, const char *macro)
{
    const uint32_t hash = hnbrdf_hash32(HNBRDF_HASH32_START, macro, strlen(macro));
    size_t at = hash & (set->slots - 1);
    while (set->table[at] && strcmp(set->table[at]->macro, macro) != 0)
        at = (at + 1) & (set->slots - 1);
    return &set->table[at];
}

/* Settles those that share their macro with none, or are the only plain one that has it. */
static void settle(const macro_set *set, named *m)
{
    named **slot = slot_of(set, m->macro), *other = *slot;
    m->settled = !other || m->plain > other->plain;
    if (other && m->plain >= other->plain)
        other->settled = 0;
    if (m->settled)
        *slot = m;
}

/* Adds this ending to the macro, and a number from 2 on where even that is taken. */
static void extend(const macro_set *set, named *m, const char *ending)
{
    char *end = m->macro + strlen(m->macro);
    const size_t room = HNBRDF_MACRO_NAME_SIZE - (size_t)(end - m->macro);
    named **slot;
    snprintf(end, room, "_%s", ending);
    for (int number = 2; *(slot = slot_of(set, m->macro)) != NULL; number++)
        snprintf(end, room, "_%s_%d", ending, number);
    *slot = m;
}

static int compare_named(const void *a, const void *b)
{
    return strcmp((*(named *const *)a)->name, (*(named *const *)b)->name);
}

static void clear(const macro_set *set)
{
    for (size_t i = 0; i < set->slots; i++)
        set->table[i] = NULL;
}

/* The materials in the order of their names, whatever theirs is in the model; order[count] has a
 * macro already. */
static void name_materials(const macro_set *set, named **order, int count)
{
    hnbrdf_sort(order, (size_t)count, sizeof *order, compare_named);
    clear(set);
    for (int k = count; k >= 0; k--)
        settle(set, order[k]);
    clear(set);
    for (int k = 0; k <= count; k++)
        if (order[k]->settled)
            *slot_of(set, order[k]->macro) = order[k];
    for (int k = 0; k < count; k++) {
        const size_t length = strlen(order[k]->name);
        char hash[9];
        snprintf(hash, sizeof hash, "%08X",
                 (unsigned)hnbrdf_hash32(HNBRDF_HASH32_START, order[k]->name, length));
        if (!order[k]->settled)
            extend(set, order[k], hash);
    }
}

/* ---- The names of a scene -------------------------------------------------------------------- */

/* `again` has room for those that the scene lists more than once. */
static void list_scene(const macro_set *set, named *materials, const int *indices, int count,
                       named *again, hnbrdf_macro_name *names)
{
    for (int k = 0; k < count; k++) {
        named *m = &materials[indices ? indices[k] : k];
        if (m->listed) {
            char place[12];
            snprintf(place, sizeof place, "%d", k);
            *again = *m;
            m = again++;
            extend(set, m, place);
        }
        m->listed = 1;
        memcpy(names[k], m->macro, sizeof m->macro);
    }
}

/* The materials of the model, then COUNT. */
static void fill(const hnbrdf_model_desc *desc, named *all, named **order)
{
    const int count = desc->material_count;
    for (int m = 0; m < count; m++) {
        all[m] = (named){.name = desc->names[m]};
        sanitise(all[m].name, all[m].macro);
        all[m].plain = only_capitals_differ(all[m].name, all[m].macro);
        order[m] = &all[m];
    }
    all[count] = (named){.plain = 2, .macro = "COUNT"}; /* before every material */
    order[count] = &all[count];
}

hnbrdf_result hnbrdf_macro_names(const hnbrdf_model *model, const int *indices, int count,
                                 hnbrdf_macro_name *names, hnbrdf_error *error)
{
    const hnbrdf_model_desc *desc = &model->desc;
    const hnbrdf_allocator *memory = &model->allocator;
    const size_t materials = (size_t)desc->material_count, entries = materials + 1 + (size_t)count;
    macro_set set = {.slots = 4};
    while (set.slots < 2 * entries)
        set.slots *= 2;
    named *all = (named *)memory->allocate(memory->user, entries * sizeof *all);
    named **order =
        (named **)memory->allocate(memory->user, (materials + 1 + set.slots) * sizeof *order);
    hnbrdf_result result = HNBRDF_OK;
    if (all && order) {
        set.table = order + materials + 1;
        fill(desc, all, order);
        name_materials(&set, order, desc->material_count);
        list_scene(&set, all, indices, count, all + materials + 1, names);
    } else {
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "export: no memory for %d names",
                             desc->material_count);
    }
    if (order)
        memory->release(memory->user, order);
    if (all)
        memory->release(memory->user, all);
    return result;
}
