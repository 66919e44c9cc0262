/* fields.c: a material changed by a text, "alpha=0.2,kd*=0.5": reads all of it, then applies it. */
#include "hnbrdf/edit.h"

#include "base/error.h"
#include "base/guess.h"
#include "base/text.h"

#include <string.h>

/* Offsets in hnbrdf_material, of the field and of what it was fitted with. */
typedef struct edit_field {
    const char *name;
    size_t offset;
    int count;     /* floats there */
    size_t fitted; /* 0: nothing is kept of it */
} edit_field;

static const edit_field fields[] = {
    {"kd", offsetof(hnbrdf_material, kd), 3, offsetof(hnbrdf_material, fitted.kd)},
    {"eta", offsetof(hnbrdf_material, eta), 3, offsetof(hnbrdf_material, fitted.eta)},
    {"alpha", offsetof(hnbrdf_material, alpha), 2, offsetof(hnbrdf_material, fitted.alpha)},
    {"alpha_x", offsetof(hnbrdf_material, alpha), 1, offsetof(hnbrdf_material, fitted.alpha)},
    {"alpha_y", offsetof(hnbrdf_material, alpha) + sizeof(float), 1,
     offsetof(hnbrdf_material, fitted.alpha) + sizeof(float)},
    {"rotation", offsetof(hnbrdf_material, rotation), 1, 0},
};
static const char FITTED[] = "fitted";
enum { FIELDS = sizeof fields / sizeof fields[0], MAX_VALUES = 3 };

/* FIELD=VALUE[:VALUE...], or with *= or +=; or FIELD=fitted. */
typedef struct assignment {
    const edit_field *field;
    char operation; /* '=', '*', '+', or 'f': what it was fitted with */
    float values[MAX_VALUES];
    int count; /* 1: the same for every float of the field */
} assignment;

static const edit_field *find_field(const char *name, size_t length, hnbrdf_error *error)
{
    char word[HNBRDF_MAX_NAME + 1];
    hnbrdf_guess guess;
    length = length < HNBRDF_MAX_NAME ? length : HNBRDF_MAX_NAME;
    memcpy(word, name, length);
    word[length] = '\0';
    hnbrdf_guess_begin(&guess, word);
    for (int k = 0; k < FIELDS; ++k) {
        if (strcmp(word, fields[k].name) == 0)
            return &fields[k];
        hnbrdf_guess_offer(&guess, fields[k].name);
    }
    const char *nearest = hnbrdf_guess_nearest(&guess);
    hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                "no field '%s', expected kd, eta, alpha, alpha_x, alpha_y or rotation%s%s%s", word,
                nearest ? " (did you mean " : "", nearest ? nearest : "", nearest ? "?)" : "");
    return NULL;
}

/* One number, of an angle also with a unit. NULL if there is none that goes up to ':' or the end.
 */
static const char *read_value(const assignment *a, const char *from, const char *end, float *value)
{
    const int is_angle =
        a->field->offset == offsetof(hnbrdf_material, rotation) && a->operation != '*';
    const char *to = hnbrdf_parse_float(from, end, value);
    if (to && is_angle && end - to >= 3 && strncmp(to, "deg", 3) == 0) {
        *value = (float)((double)*value * (3.14159265358979324 / 180.0));
        to += 3;
    } else if (to && is_angle && end - to >= 3 && strncmp(to, "rad", 3) == 0) {
        to += 3;
    }
    return to && (to == end || *to == ':') ? to : NULL;
}

static hnbrdf_result read_values(assignment *a, const char *from, const char *end,
                                 hnbrdf_error *error)
{
    const edit_field *f = a->field;
    if (f->fitted && a->operation == '=' && (size_t)(end - from) == sizeof FITTED - 1 &&
        strncmp(from, FITTED, sizeof FITTED - 1) == 0) {
        a->operation = 'f';
        return HNBRDF_OK;
    }
    for (;;) {
        float value;
        const char *to = read_value(a, from, end, &value);
        if (!to) {
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s: '%.*s' is not %s", f->name,
                               (int)(end - from), from,
                               f->count > 1 ? "a number, or numbers with ':' between" : "a number");
        }
        if (a->count < MAX_VALUES)
            a->values[a->count] = value;
        a->count++;
        if (to == end)
            break;
        from = to + 1;
    }
    if (a->count == 1 || a->count == f->count)
        return HNBRDF_OK;
    static const char *const expected[] = {"1", "1 or 2, x:y", "1 or 3, R:G:B"};
    return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s: found %d values, expected %s", f->name,
                       a->count, expected[f->count - 1]);
}

/* The assignment in [from, end). */
static hnbrdf_result read_assignment(assignment *a, const char *from, const char *end,
                                     hnbrdf_error *error)
{
    const char *equals = (const char *)memchr(from, '=', (size_t)(end - from));
    if (!equals) {
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "'%.*s' is not FIELD=VALUE",
                           (int)(end - from), from);
    }
    const char *name_end = equals;
    a->operation = '=';
    if (equals > from && (equals[-1] == '*' || equals[-1] == '+'))
        a->operation = *--name_end;
    a->field = find_field(from, (size_t)(name_end - from), error);
    return a->field ? read_values(a, equals + 1, end, error) : HNBRDF_ERROR_ARGUMENT;
}

static void apply(const assignment *a, hnbrdf_material *material)
{
    float *at = (float *)(void *)((char *)material + a->field->offset);
    if (a->operation == 'f') {
        memcpy(at, (const char *)material + a->field->fitted, (size_t)a->field->count * sizeof *at);
        return;
    }
    for (int k = 0; k < a->field->count; ++k) {
        const float value = a->values[a->count > 1 ? k : 0];
        at[k] = a->operation == '=' ? value : a->operation == '*' ? at[k] * value : at[k] + value;
    }
}

hnbrdf_result hnbrdf_material_set(hnbrdf_material *material, const char *text, hnbrdf_error *error)
{
    if (!material || !text)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s is NULL",
                           material ? "text" : "material");
    hnbrdf_material changed = *material;
    for (;;) {
        const char *end = text + strcspn(text, ",");
        assignment a = {.count = 0};
        const hnbrdf_result result = read_assignment(&a, text, end, error);
        if (result)
            return result;
        if (a.operation == 'f' && changed.fitted.alpha[0] == 0.0f)
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                               "%s=%s: it is not known what the material was fitted with",
                               a.field->name, FITTED);
        apply(&a, &changed);
        if (*end == '\0')
            break;
        text = end + 1;
    }
    *material = changed;
    return HNBRDF_OK;
}
