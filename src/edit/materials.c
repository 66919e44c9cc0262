/* materials.c: a model with other materials: the changes are made to a list, and a model is
 * created of the list and the old network. */
#include "hnbrdf/edit.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "model/check_name.h"

#include <stdint.h>
#include <string.h>

/* The materials as the changes so far have left them. */
typedef struct material_list {
    const hnbrdf_model *model;
    hnbrdf_material *materials;
    const char **names; /* of the model or of the caller */
    uint32_t *hashes;   /* of the names: finding one of many thousands takes microseconds */
    int count;
    int next; /* behind the one that was found last: changes mostly come in order */
} material_list;

/* For the progress of one change: its number, of how many. */
typedef struct change_place {
    const hnbrdf_edit_options *options;
    int index, count;
} change_place;

static hnbrdf_result fail(hnbrdf_error *error, const char *format, const char *name)
{
    return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, format, name);
}

static uint32_t hash_of(const char *name)
{
    return hnbrdf_hash32(HNBRDF_HASH32_START, name, strlen(name));
}

static void set_name(material_list *list, int index, const char *name)
{
    list->names[index] = name;
    list->hashes[index] = hash_of(name);
}

static int find(material_list *list, const char *name)
{
    const uint32_t hash = hash_of(name);
    int at = list->next;
    if (at >= list->count || strcmp(list->names[at], name) != 0) {
        for (at = 0; at < list->count; ++at)
            if (list->hashes[at] == hash && strcmp(list->names[at], name) == 0)
                break;
    }
    if (at == list->count)
        return -1;
    list->next = at + 1;
    return at;
}

/* ---- Lobes ----------------------------------------------------------------------------------- */

static hnbrdf_result set_lobes(const hnbrdf_model *model, hnbrdf_lobes_scheme scheme,
                               const char *name, hnbrdf_material *material, hnbrdf_error *error)
{
    hnbrdf_error inner;
    hnbrdf_result result;
    switch (scheme) {
    case HNBRDF_LOBES_KEEP:
        return HNBRDF_OK;
    case HNBRDF_LOBES_FIT:
        result = hnbrdf_lobes_fit(model, material, &material->lobes, &inner);
        return result ? hnbrdf_fail(error, result, "%s: %s", name, inner.text) : HNBRDF_OK;
    case HNBRDF_LOBES_PAPER:
    case HNBRDF_LOBES_GUESS:
        memset(&material->lobes, 0, sizeof material->lobes);
        if (scheme == HNBRDF_LOBES_PAPER)
            hnbrdf_lobes_paper(&material->lobes);
        return HNBRDF_OK;
    }
    return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                       "%s: lobes is %d, expected an HNBRDF_LOBES_ constant", name, (int)scheme);
}

/* `part` of this change is done. */
static hnbrdf_result report(const change_place *place, double part, const char *name,
                            hnbrdf_error *error)
{
    const double share = (place->index + part) / place->count;
    if (!place->options->progress ||
        place->options->progress(place->options->progress_user, share, name) == 0)
        return HNBRDF_OK;
    return hnbrdf_fail(error, HNBRDF_ERROR_CANCELLED, "editing was stopped at material %s", name);
}

static hnbrdf_result change_lobes(material_list *list, int first, int count,
                                  hnbrdf_lobes_scheme scheme, const change_place *place,
                                  hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    for (int k = 0; k < count && !result; ++k) {
        const char *name = list->names[first + k];
        result = set_lobes(list->model, scheme, name, &list->materials[first + k], error);
        if (!result)
            result = report(place, (k + 1.0) / count, name, error);
    }
    return result;
}

/* ---- Changes --------------------------------------------------------------------------------- */

static hnbrdf_result check_new_name(const char *name, hnbrdf_error *error)
{
    hnbrdf_error inner;
    const hnbrdf_result result = hnbrdf_check_name(name, &inner);
    return result ? hnbrdf_fail(error, result, "the new name of a material %s", inner.text)
                  : HNBRDF_OK;
}

/* At `index`, or at the end where that is negative. */
static hnbrdf_result put(material_list *list, int index, const hnbrdf_material_change *change,
                         hnbrdf_error *error)
{
    hnbrdf_error inner;
    hnbrdf_result result;
    if (!change->material)
        return fail(error, "%s: material is NULL, expected one", change->name);
    if ((result = hnbrdf_material_check(change->material, &inner)))
        return hnbrdf_fail(error, result, "%s: %s", change->name, inner.text);
    if (index < 0 && list->count == HNBRDF_MAX_MATERIALS) {
        return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT, "%s: the model has %d materials already",
                           change->name, list->count);
    }
    hnbrdf_material made = *change->material;
    if ((index < 0 && (result = check_new_name(change->name, error))) ||
        (result = set_lobes(list->model, change->lobes, change->name, &made, error)))
        return result;
    if (index < 0) {
        index = list->count++;
        set_name(list, index, change->name);
    }
    list->materials[index] = made;
    return HNBRDF_OK;
}

static void remove_at(material_list *list, int index)
{
    const size_t after = (size_t)(list->count - index - 1);
    memmove(list->materials + index, list->materials + index + 1, after * sizeof(hnbrdf_material));
    memmove(list->names + index, list->names + index + 1, after * sizeof(char *));
    memmove(list->hashes + index, list->hashes + index + 1, after * sizeof(uint32_t));
    list->count--;
    list->next = index;
}

static hnbrdf_result rename_at(material_list *list, int index, const char *name,
                               hnbrdf_error *error)
{
    const hnbrdf_result result = check_new_name(name, error);
    if (result)
        return result;
    const int taken = find(list, name);
    if (taken >= 0 && taken != index)
        return fail(error, "there is a material %s already, expected a new name", name);
    set_name(list, index, name);
    return HNBRDF_OK;
}

static hnbrdf_result apply(material_list *list, const hnbrdf_material_change *change,
                           const change_place *place, hnbrdf_error *error)
{
    const hnbrdf_change_kind kind = change->kind;
    hnbrdf_result result = HNBRDF_OK;
    if (kind == HNBRDF_CHANGE_LOBES && !change->name)
        return change_lobes(list, 0, list->count, change->lobes, place, error);
    if (!change->name) {
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "change %d has name NULL, expected the name of a material",
                           place->index);
    }
    const int index = find(list, change->name);
    if (index < 0 && kind != HNBRDF_CHANGE_PUT && kind != HNBRDF_CHANGE_ADD)
        return fail(error, "there is no material %s, expected one of the model", change->name);
    if (index >= 0 && kind == HNBRDF_CHANGE_ADD)
        return fail(error, "there is a material %s already, expected a new name", change->name);
    switch (kind) {
    case HNBRDF_CHANGE_PUT:
    case HNBRDF_CHANGE_ADD:
    case HNBRDF_CHANGE_REPLACE:
        result = put(list, index, change, error);
        break;
    case HNBRDF_CHANGE_REMOVE:
        remove_at(list, index);
        break;
    case HNBRDF_CHANGE_RENAME:
        result = rename_at(list, index, change->new_name, error);
        break;
    case HNBRDF_CHANGE_LOBES:
        return change_lobes(list, index, 1, change->lobes, place, error);
    }
    return result ? result : report(place, 1.0, change->name, error);
}

static hnbrdf_result apply_all(material_list *list, const hnbrdf_material_change *changes,
                               int count, const hnbrdf_edit_options *options, hnbrdf_error *error)
{
    change_place place = {options, 0, count};
    hnbrdf_result result = HNBRDF_OK;
    for (; place.index < count && !result; ++place.index) {
        const hnbrdf_material_change *change = &changes[place.index];
        if ((int)change->kind < 0 || change->kind > HNBRDF_CHANGE_LOBES) {
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                               "change %d has kind %d, expected an HNBRDF_CHANGE_ constant",
                               place.index, (int)change->kind);
        }
        result = apply(list, change, &place, error);
    }
    if (!result && list->count == 0) {
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "the changes leave no material, expected at least one");
    }
    return result;
}

/* ---- All of it ------------------------------------------------------------------------------- */

/* How many materials there may be on the way. */
static size_t capacity_for(const hnbrdf_model_desc *desc, const hnbrdf_material_change *changes,
                           int count)
{
    size_t capacity = (size_t)desc->material_count;
    for (int k = 0; k < count && capacity < HNBRDF_MAX_MATERIALS; ++k)
        capacity += changes[k].kind == HNBRDF_CHANGE_PUT || changes[k].kind == HNBRDF_CHANGE_ADD;
    return capacity;
}

static hnbrdf_result create(hnbrdf_model_desc *desc, const material_list *list,
                            const hnbrdf_allocator *memory, hnbrdf_model **out, hnbrdf_error *error)
{
    desc->material_count = list->count;
    desc->materials = list->materials;
    desc->names = list->names;
    return hnbrdf_model_create(desc, memory, out, error);
}

hnbrdf_result hnbrdf_model_with_materials(const hnbrdf_model *model,
                                          const hnbrdf_material_change *changes, int count,
                                          const hnbrdf_edit_options *options, hnbrdf_model **out,
                                          hnbrdf_error *error)
{
    static const hnbrdf_edit_options defaults = {0};
    hnbrdf_allocator memory;
    hnbrdf_model_desc desc;
    hnbrdf_result result;
    if (!model || !out || (!changes && count > 0))
        return fail(error, "%s is NULL", !model ? "model" : !out ? "out" : "changes");
    if (count < 0)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "count is %d, expected at least 0", count);
    options = options ? options : &defaults;
    if ((result = hnbrdf_choose_allocator(&options->allocator, &memory, error)))
        return result;
    hnbrdf_model_describe(model, &desc);
    const size_t capacity = capacity_for(&desc, changes, count);
    const size_t size = capacity * (sizeof(char *) + sizeof(hnbrdf_material) + sizeof(uint32_t));
    /* Names first: pointers need the strictest alignment. */
    const char **names = (const char **)hnbrdf_allocate(&memory, size);
    if (!names)
        return hnbrdf_fail_memory(error, size, "the materials");
    material_list list = {.model = model,
                          .materials = (hnbrdf_material *)(void *)(names + capacity),
                          .names = names,
                          .count = desc.material_count};
    memcpy(list.materials, desc.materials, (size_t)list.count * sizeof *list.materials);
    list.hashes = (uint32_t *)(void *)(list.materials + capacity);
    for (int k = 0; k < list.count; ++k)
        set_name(&list, k, desc.names[k]);
    result = apply_all(&list, changes, count, options, error);
    if (!result)
        result = create(&desc, &list, &memory, out, error);
    hnbrdf_release(&memory, names);
    return result;
}
