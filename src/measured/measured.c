/* measured.c: open a measured material from a file, from memory or from the built-in list, and
 * ask it for values. Which format it is, is decided by the table of formats.c; everything else lies
 * in the formats. */
#include "measured/format.h"
#include "measured/read_file.h"
#include "base/error.h"
#include "base/foreign.h"
#include "base/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of a path in a message: leaves room for what was found and expected. */
enum { LABEL_SIZE = 161 };

struct hnbrdf_measured {
    hnbrdf_measured_format format;
    measured_body body;
    char name[HNBRDF_MAX_NAME + 1];
};

/* ---- Names ----------------------------------------------------------------------------------- */

/* Bytes of the character at p, 0 if it is a control character or not UTF-8. p ends with NUL. */
static size_t character_length(const char *p)
{
    const unsigned char first = (unsigned char)*p;
    const char *end = p;
    while (end < p + 4 && *end)
        end++;
    return first < 0x20 || first == 0x7f ? 0 : hnbrdf_utf8_length(p, end);
}

/* Copies text[0..length), cut at a character to fit size - 1 bytes; what is not UTF-8 and what is a
 * control character becomes '_'. text is NUL-terminated somewhere at or after length. */
static void copy_clean(char *out, size_t size, const char *text, size_t length)
{
    size_t n = 0;
    for (size_t i = 0; i < length;) {
        size_t step = character_length(text + i);
        if (n + (step ? step : 1) >= size)
            break;
        if (step)
            memcpy(out + n, text + i, step);
        else
            out[n] = '_';
        n += step ? step : 1;
        i += step ? step : 1;
    }
    out[n] = 0;
}

/* The path as messages show it: long ones lose their beginning. */
static void make_label(char label[LABEL_SIZE], const char *path)
{
    size_t length = strlen(path), most = LABEL_SIZE - 1;
    if (length <= most) {
        copy_clean(label, LABEL_SIZE, path, length);
        return;
    }
    const char *tail = path + (length - (most - 3));
    while (((unsigned char)*tail & 0xc0) == 0x80)
        tail++;
    memcpy(label, "...", 3);
    copy_clean(label + 3, LABEL_SIZE - 3, tail, strlen(tail));
}

static const char *base_name(const char *path)
{
    const char *base = path;
    for (const char *p = path; *p; p++)
        if (*p == '/')
            base = p + 1;
#ifdef _WIN32
    for (const char *p = base; *p; p++)
        if (*p == '\\')
            base = p + 1;
#endif
    return base;
}

/* The file's name without directory, extension (and what numbers the parts of a material in several
 * files) and a trailing "_rgb"; all of it if nothing is left. */
static void make_name(char name[HNBRDF_MAX_NAME + 1], const char *path)
{
    const char *base = base_name(path), *dot = strrchr(base, '.');
    size_t length = dot ? (size_t)(dot - base) : strlen(base), stem;
    int part = -1;
    if (hnbrdf_measured_format_of_file(base, &stem, &part) && part >= 0)
        length = stem;
    if (length >= 4 && memcmp(base + length - 4, "_rgb", 4) == 0)
        length -= 4;
    if (length == 0)
        length = strlen(base);
    copy_clean(name, HNBRDF_MAX_NAME + 1, base, length);
    if (!name[0])
        memcpy(name, "unnamed", sizeof "unnamed");
}

/* ---- Opening --------------------------------------------------------------------------------- */

/* What the file is instead of measured data, by its content, else by its name; NULL: unknown. */
static const char *instead(const measured_file *file, const char *path)
{
    const char *by_name = hnbrdf_foreign_name(path, file->bytes, file->size);
    if (hnbrdf_foreign_lookalike(path))
        return by_name;
    const char *what = hnbrdf_foreign_file(file->bytes, file->size);
    if (!what)
        what = hnbrdf_own_file(file->bytes, file->size);
    return what ? what : file->size == 0 ? "empty" : by_name;
}

static hnbrdf_result unrecognised(const measured_file *file, const char *path, hnbrdf_error *error)
{
    char expected[sizeof error->text], start[3 * 12 + 1] = "";
    hnbrdf_measured_expected(expected, sizeof expected);
    const char *what = instead(file, path);
    if (what)
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: %s, %s", file->label, what, expected);
    for (size_t i = 0; i < 12 && i < file->size; i++)
        snprintf(start + 3 * i, sizeof start - 3 * i, " %02x", file->bytes[i]);
    return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: %zu bytes starting with%s, %s", file->label,
                       file->size, start, expected);
}

/* The row of the format that the content claims, or NULL. */
static const measured_reader *recognise(const measured_file *file)
{
    const measured_reader *reader;
    for (int k = 0; (reader = hnbrdf_measured_reader_at(k)); k++)
        if (reader->recognise && reader->recognise(file))
            return reader;
    return NULL;
}

static hnbrdf_result open_file(const measured_file *file, const char *path,
                               const hnbrdf_measured_options *options, hnbrdf_measured **measured,
                               hnbrdf_error *error)
{
    const measured_reader *reader = hnbrdf_foreign_lookalike(path) ? NULL : recognise(file);
    if (!reader)
        return unrecognised(file, path, error);
    hnbrdf_measured *opened = calloc(1, sizeof *opened);
    if (!opened)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: out of memory", file->label);
    opened->format = reader->info.format;
    hnbrdf_result result = reader->open(file, options, &opened->body, error);
    if (result) {
        free(opened);
        return result;
    }
    make_name(opened->name, path);
    opened->body.bytes = opened->body.bytes ? opened->body.bytes : file->size;
    *measured = opened;
    return HNBRDF_OK;
}

static int can_be_read(const char *path)
{
    FILE *stream = fopen(path, "rb");
    if (stream)
        fclose(stream);
    return stream != NULL;
}

/* Where `path` is no file but the name of a material in several: the path of a part that is there,
 * malloc'ed. NULL if it is a file, or there is none, or no memory. */
static char *find_part(const char *path)
{
    const hnbrdf_measured_format_info *info;
    size_t size = strlen(path) + 32;
    char *part = can_be_read(path) ? NULL : malloc(size);
    for (int row = 0; part && (info = hnbrdf_measured_format_at(row)); row++)
        for (int k = 0; info->part_endings && info->part_endings[k]; k++) {
            snprintf(part, size, "%s%s", path, info->part_endings[k]);
            if (can_be_read(part))
                return part;
        }
    free(part);
    return NULL;
}

static hnbrdf_result open_path(const char *path, const hnbrdf_measured_options *options,
                               hnbrdf_measured **measured, hnbrdf_error *error)
{
    char label[LABEL_SIZE];
    make_label(label, path);
    unsigned char *bytes = NULL;
    measured_file file = {.label = label, .path = path};
    hnbrdf_result result =
        hnbrdf_read_file(path, options->max_bytes, label, &bytes, &file.size, error);
    file.bytes = bytes;
    if (!result)
        result = open_file(&file, path, options, measured, error);
    free(bytes);
    return result;
}

hnbrdf_result hnbrdf_measured_open(const char *path, const hnbrdf_measured_options *options,
                                   hnbrdf_measured **measured, hnbrdf_error *error)
{
    if (!path || !measured)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "hnbrdf_measured_open: path or result is NULL");
    hnbrdf_measured_options settled;
    hnbrdf_result result = hnbrdf_measured_settle(options, &settled, error);
    if (result)
        return result;
    char *part = find_part(path);
    result = open_path(part ? part : path, &settled, measured, error);
    free(part);
    return result;
}

hnbrdf_result hnbrdf_measured_open_memory(const void *data, size_t size, const char *path,
                                          const hnbrdf_measured_options *options,
                                          hnbrdf_measured **measured, hnbrdf_error *error)
{
    if (!path || !measured || (!data && size))
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "hnbrdf_measured_open_memory: data, path or result is NULL");
    char label[LABEL_SIZE];
    hnbrdf_measured_options settled;
    hnbrdf_result result = hnbrdf_measured_settle(options, &settled, error);
    if (result)
        return result;
    make_label(label, path);
    if (size > settled.max_bytes)
        return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT, "%s: %zu bytes, larger than the limit of %zu",
                           label, size, settled.max_bytes);
    measured_file file = {.bytes = data, .size = size, .label = label};
    return open_file(&file, path, &settled, measured, error);
}

typedef hnbrdf_result open_numbered(int number, measured_body *body, hnbrdf_error *error);

static hnbrdf_result open_formula(open_numbered *open, int number, const char *name,
                                  hnbrdf_measured **measured, hnbrdf_error *error)
{
    hnbrdf_measured *opened = calloc(1, sizeof *opened);
    if (!opened)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: out of memory", name);
    opened->format = HNBRDF_MEASURED_BUILTIN;
    hnbrdf_result result = open(number, &opened->body, error);
    if (result) {
        free(opened);
        return result;
    }
    copy_clean(opened->name, sizeof opened->name, name, strlen(name));
    *measured = opened;
    return HNBRDF_OK;
}

hnbrdf_result hnbrdf_measured_open_builtin(int index, hnbrdf_measured **measured,
                                           hnbrdf_error *error)
{
    const char *name = hnbrdf_measured_builtin_name(index);
    if (!name || !measured)
        return hnbrdf_fail(
            error, HNBRDF_ERROR_ARGUMENT, "built-in material %d: expected 0 to %d%s", index,
            hnbrdf_measured_builtin_count() + hnbrdf_measured_builtin_anisotropic_count() - 1,
            measured ? "" : " and a place for the result");
    return open_formula(hnbrdf_builtin_open, index, name, measured, error);
}

hnbrdf_result hnbrdf_measured_open_procedural(int number, hnbrdf_measured **measured,
                                              hnbrdf_error *error)
{
    char name[32];
    if (number < 0 || number > HNBRDF_MAX_PROCEDURAL || !measured)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "procedural material %d: expected 0 to %d%s", number,
                           HNBRDF_MAX_PROCEDURAL, measured ? "" : " and a place for the result");
    snprintf(name, sizeof name, "procedural-%d", number);
    return open_formula(hnbrdf_procedural_open, number, name, measured, error);
}

hnbrdf_result hnbrdf_measured_create_custom(const hnbrdf_measured_custom *custom,
                                            hnbrdf_measured **measured, hnbrdf_error *error)
{
    if (!custom || !measured || !custom->eval || !custom->name)
        return hnbrdf_fail(
            error, HNBRDF_ERROR_ARGUMENT,
            "hnbrdf_measured_create_custom: description, name, eval or result is NULL");
    hnbrdf_measured *made = calloc(1, sizeof *made);
    if (!made)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory for a custom material");
    size_t length = strlen(custom->name);
    copy_clean(made->name, sizeof made->name, custom->name, length);
    made->format = HNBRDF_MEASURED_CUSTOM;
    hnbrdf_result result = HNBRDF_OK;
    if (length == 0 || strcmp(made->name, custom->name) != 0)
        result =
            hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                        "custom material '%s': expected a name of 1 to %d bytes of UTF-8 without "
                        "control characters",
                        made->name, HNBRDF_MAX_NAME);
    if (!result)
        result = hnbrdf_custom_open(custom, &made->body, error);
    if (result) {
        free(made);
        return result;
    }
    *measured = made;
    return HNBRDF_OK;
}

void hnbrdf_measured_close(hnbrdf_measured *measured)
{
    if (!measured)
        return;
    measured->body.release(measured->body.data);
    free(measured);
}

/* ---- Asking ---------------------------------------------------------------------------------- */

const char *hnbrdf_measured_name(const hnbrdf_measured *measured)
{
    return measured->name;
}

hnbrdf_measured_format hnbrdf_measured_format_of(const hnbrdf_measured *measured)
{
    return measured->format;
}

int hnbrdf_measured_is_isotropic(const hnbrdf_measured *measured)
{
    return measured->body.isotropic;
}

const char *hnbrdf_measured_summary(const hnbrdf_measured *measured)
{
    return measured->body.summary;
}

const char *hnbrdf_measured_published(const hnbrdf_measured *measured)
{
    return measured->body.published;
}

size_t hnbrdf_measured_bytes(const hnbrdf_measured *measured)
{
    return measured->body.bytes;
}

size_t hnbrdf_measured_wavelengths(const hnbrdf_measured *measured, const float **nm)
{
    if (nm && measured->body.wavelength_count)
        *nm = measured->body.wavelengths;
    return measured->body.wavelength_count;
}

/* The unit vector along w in double precision; 0 if w is not finite or not above the horizon. */
static int unit_above_horizon(const float w[3], double unit[3])
{
    if (!(w[2] > 0.0f) || !isfinite(w[0]) || !isfinite(w[1]) || !isfinite(w[2]))
        return 0;
    double x = w[0], y = w[1], z = w[2], scale = 1.0 / sqrt(x * x + y * y + z * z);
    unit[0] = x * scale;
    unit[1] = y * scale;
    unit[2] = z * scale;
    return 1;
}

/* Within [lowest, HNBRDF_MAX_VALUE]; NaN is 0. */
static float clamp_value(double value, float lowest)
{
    if (!(value > (double)lowest))
        return value <= (double)lowest ? lowest : 0.0f;
    return value < (double)HNBRDF_MAX_VALUE ? (float)value : HNBRDF_MAX_VALUE;
}

int hnbrdf_measured_eval(const hnbrdf_measured *measured, const float wi[3], const float wo[3],
                         float f[3])
{
    double i[3], o[3], value[3];
    f[0] = f[1] = f[2] = 0.0f;
    if (!unit_above_horizon(wi, i) || !unit_above_horizon(wo, o) ||
        !measured->body.eval(measured->body.data, i, o, value))
        return 0;
    for (int c = 0; c < 3; c++)
        f[c] = clamp_value(value[c], measured->body.is_signed ? -HNBRDF_MAX_VALUE : 0.0f);
    return 1;
}

int hnbrdf_measured_eval_spectrum(const hnbrdf_measured *measured, const float wi[3],
                                  const float wo[3], size_t count, const float *nm, float *f)
{
    double i[3], o[3];
    if (measured->body.eval_spectrum && unit_above_horizon(wi, i) && unit_above_horizon(wo, o) &&
        measured->body.eval_spectrum(measured->body.data, i, o, count, nm, f))
        return 1;
    for (size_t k = 0; k < count; k++)
        f[k] = 0.0f;
    return 0;
}
