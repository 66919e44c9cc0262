/* describe.c: read a scene as text, of any origin. The language is told in describe.h. */
#include "scene/words.h"

#include "base/text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_MATERIALS = RENDER_MAX_SURFACES };

/* ---- Statements ------------------------------------------------------------------------------ */

static hnbrdf_result read_camera(words *in)
{
    render_camera *camera = &in->out->camera;
    hnbrdf_result result = HNBRDF_OK;
    double value = 0.0;
    if (in->has_camera++)
        return BAD(in, "%s:%ld: a second camera", in->name, in->line);
    int seen = 0;
    while (in->at < in->count && result == HNBRDF_OK)
        if (words_take(in, "from"))
            result = words_vector(in, "from", -WORDS_FAR, WORDS_FAR, camera->from), seen |= 1;
        else if (words_take(in, "to"))
            result = words_vector(in, "to", -WORDS_FAR, WORDS_FAR, camera->to), seen |= 2;
        else if (words_take(in, "up"))
            result = words_vector(in, "up", -1.0, 1.0, camera->up);
        else if (words_take(in, "fov"))
            result = words_number(in, "fov", 0.1, 170.0, &value), camera->fov = (float)value,
            seen |= 4;
        else if (words_take(in, "lens"))
            result = words_number(in, "lens", 0.0, WORDS_FAR, &value), camera->lens = (float)value;
        else if (words_take(in, "focus"))
            result = words_number(in, "focus", 1e-6, WORDS_FAR, &value),
            camera->focus = (float)value;
        else
            result = words_unknown(in, "from, to, fov, up, lens or focus");
    if (result == HNBRDF_OK && seen != 7)
        return BAD(in, "%s:%ld: a camera needs from X Y Z, to X Y Z and fov DEG", in->name,
                   in->line);
    return result;
}

static hnbrdf_result read_environment(words *in)
{
    render_description *out = in->out;
    if (out->environment[0])
        return BAD(in, "%s:%ld: a second environment; the first is on line %ld", in->name, in->line,
                   out->environment_line);
    hnbrdf_result result = words_text(in, "environment", sizeof out->environment, out->environment);
    out->environment_line = in->line;
    while (in->at < in->count && result == HNBRDF_OK)
        if (words_take(in, "rotate"))
            result = words_number(in, "rotate", -360.0, 360.0, &out->rotate);
        else if (words_take(in, "gain"))
            result = words_number(in, "gain", 1e-6, 1e6, &out->gain);
        else if (words_take(in, "hidden"))
            out->hidden = 1;
        else if (words_take(in, "layer"))
            result = words_text(in, "layer", sizeof out->environment_layer, out->environment_layer);
        else if (words_take(in, "repair"))
            out->environment_repair = 1;
        else
            result = words_unknown(in, "rotate, gain, hidden, layer or repair");
    return result;
}

static hnbrdf_result read_portal(words *in)
{
    render_description *out = in->out;
    if (out->portal_count == RENDER_MAX_PORTALS)
        return BAD(in, "%s:%ld: more than %d portals", in->name, in->line, RENDER_MAX_PORTALS);
    render_portal *portal = &out->portals[out->portal_count];
    hnbrdf_result result = words_take(in, "corner")
                               ? words_vector(in, "corner", -WORDS_FAR, WORDS_FAR, portal->corner)
                               : words_unknown(in, "corner X Y Z edge X Y Z edge X Y Z");
    for (int k = 0; k < 2 && result == HNBRDF_OK; k++)
        result = words_take(in, "edge")
                     ? words_vector(in, "edge", -WORDS_FAR, WORDS_FAR, portal->edge[k])
                     : words_unknown(in, "edge X Y Z");
    out->portal_count += result == HNBRDF_OK;
    return result;
}

static hnbrdf_result read_ggx(words *in, render_text_material *material)
{
    hnbrdf_result result = HNBRDF_OK;
    double alpha[2] = {0.5, 0.5};
    while (in->at < in->count && result == HNBRDF_OK) {
        if (words_take(in, "kd")) {
            result = words_vector(in, "kd", 0.0, 1.0, material->ggx.kd);
        } else if (words_take(in, "eta")) {
            result = words_vector(in, "eta", 1.00001, (double)HNBRDF_MAX_ETA, material->ggx.eta);
        } else if (words_take(in, "alpha")) {
            result = words_number(in, "alpha", (double)HNBRDF_MIN_ALPHA, 1.0, &alpha[0]);
            alpha[1] = alpha[0];
            if (result == HNBRDF_OK && in->at < in->count &&
                strchr("0123456789.", in->words[in->at][0]) && in->words[in->at][0])
                result = words_number(in, "alpha", (double)HNBRDF_MIN_ALPHA, 1.0, &alpha[1]);
        } else {
            result = words_unknown(in, "kd R G B, eta R G B or alpha A");
        }
    }
    for (int k = 0; k < 2; k++)
        material->ggx.alpha[k] = fmaxf((float)alpha[k], HNBRDF_MIN_ALPHA);
    return result;
}

/* The reflectance of this eta is 2.5e-11. */
static hnbrdf_result read_diffuse(words *in, render_text_material *material)
{
    for (int k = 0; k < 3; k++)
        material->ggx.eta[k] = 1.00001f;
    material->ggx.alpha[0] = material->ggx.alpha[1] = 1.0f;
    return words_vector(in, "diffuse", 0.0, 1.0, material->ggx.kd);
}

static hnbrdf_result read_source(words *in, render_text_material *material)
{
    hnbrdf_result result;
    if (words_take(in, "model")) {
        material->source = RENDER_FROM_MODEL;
        result = words_text(in, "model", sizeof material->file, material->file);
        if (result == HNBRDF_OK && in->at < in->count)
            result = words_text(in, "material of a model", sizeof material->which, material->which);
    } else if (words_take(in, "measured")) {
        material->source = RENDER_FROM_MEASURED;
        result = words_text(in, "measured", sizeof material->file, material->file);
    } else if (words_take(in, "builtin")) {
        material->source = RENDER_FROM_BUILTIN;
        result = words_text(in, "builtin", sizeof material->which, material->which);
    } else if (words_take(in, "ggx")) {
        result = read_ggx(in, material);
    } else if (words_take(in, "diffuse")) {
        result = read_diffuse(in, material);
    } else {
        result = words_unknown(in, "model, measured, builtin, ggx or diffuse");
    }
    return result;
}

static hnbrdf_result read_material(words *in)
{
    render_description *out = in->out;
    if (out->material_count == MAX_MATERIALS)
        return BAD(in, "%s:%ld: more than %d materials", in->name, in->line, MAX_MATERIALS);
    void *all = describe_grown(out->materials, out->material_count, sizeof *out->materials);
    if (!all)
        return words_no_memory(in);
    out->materials = all;
    render_text_material *material = &out->materials[out->material_count];
    memset(material, 0, sizeof *material);
    hnbrdf_material_init(&material->ggx);
    material->line = in->line;
    material->source = RENDER_FROM_GGX;
    hnbrdf_result result = words_text(in, "material", sizeof material->name, material->name);
    if (result == HNBRDF_OK && describe_find_material(out, material->name) >= 0)
        return BAD(in, "%s:%ld: a second material '%s'; the first is on line %ld", in->name,
                   in->line, material->name,
                   out->materials[describe_find_material(out, material->name)].line);
    if (result == HNBRDF_OK)
        result = read_source(in, material);
    out->material_count += result == HNBRDF_OK;
    return result;
}

/* ---- Lines ----------------------------------------------------------------------------------- */

static hnbrdf_result read_size(words *in)
{
    hnbrdf_result result = words_whole(in, "width", 1, 16384, &in->out->camera.width);
    return result == HNBRDF_OK ? words_whole(in, "height", 1, 16384, &in->out->camera.height)
                               : result;
}

static hnbrdf_result read_statement(words *in)
{
    hnbrdf_result result;
    if (words_take(in, "camera"))
        result = read_camera(in);
    else if (words_take(in, "size"))
        result = read_size(in);
    else if (words_take(in, "exposure"))
        result = words_number(in, "exposure", -64.0, 64.0, &in->out->exposure);
    else if (words_take(in, "bounces"))
        result = words_whole(in, "bounces", 1, 1024, &in->out->bounces);
    else if (words_take(in, "environment"))
        result = read_environment(in);
    else if (words_take(in, "portal"))
        result = read_portal(in);
    else if (words_take(in, "material"))
        result = read_material(in);
    else if (words_take(in, "shape"))
        result = describe_shape(in);
    else
        return words_unknown(
            in, "camera, size, exposure, bounces, environment, portal, material or shape");
    return result == HNBRDF_OK && in->at < in->count ? words_unknown(in, "the end of the line")
                                                     : result;
}

/* Copies the line that begins at data into the reader; returns its bytes with the line end, 0
 * after a message. */
static size_t copy_line(words *in, const char *data, size_t size)
{
    const char *end = memchr(data, '\n', size);
    size_t length = end ? (size_t)(end - data) : size;
    in->line++;
    if (length >= WORDS_LINE || memchr(data, '\0', length)) {
        BAD(in, "%s:%ld: %s", in->name, in->line,
            length >= WORDS_LINE ? "a line of more than 8191 bytes" : "a NUL byte, expected text");
        return 0;
    }
    memcpy(in->text, data, length);
    in->text[length] = '\0';
    return length + (end != NULL);
}

hnbrdf_result render_description_parse(const void *data, size_t size, const char *name,
                                       render_description *description, hnbrdf_error *error)
{
    render_description out = {.gain = 1.0, .exposure = NAN, .camera = {.up = {0.0f, 1.0f, 0.0f}}};
    words in = {.name = name, .out = &out, .error = error};
    snprintf(out.name, sizeof out.name, "%s", name);
    hnbrdf_result result = HNBRDF_OK;
    if (size > RENDER_MAX_TEXT)
        result = hnbrdf_fail(error, HNBRDF_ERROR_LIMIT, "%s: %zu bytes, expected at most %zu", name,
                             size, (size_t)RENDER_MAX_TEXT);
    if (hnbrdf_is_utf16(data, size))
        result = BAD(&in, "%s: found UTF-16, expected UTF-8", name);
    for (size_t at = hnbrdf_byte_order_mark(data, size); at < size && result == HNBRDF_OK;) {
        size_t length = copy_line(&in, (const char *)data + at, size - at);
        at += length;
        result = length ? words_split(&in) : HNBRDF_ERROR_FORMAT;
        if (result == HNBRDF_OK && in.count)
            result = read_statement(&in);
    }
    if (result == HNBRDF_OK && (!in.has_camera || !out.shape_count))
        result = BAD(&in, "%s: no %s in %ld lines: expected a scene", name,
                     in.has_camera ? "shape" : "camera", in.line);
    if (result == HNBRDF_OK)
        *description = out;
    else
        render_description_free(&out);
    return result;
}

void render_description_free(render_description *description)
{
    free(description->materials);
    free(description->shapes);
    memset(description, 0, sizeof *description);
}
