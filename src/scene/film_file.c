/* film_file.c: the file that keeps a film. */
#include "scene/film.h"

#include "base/error.h"
#include "base/files.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct header {
    char magic[16];
    uint64_t fingerprint;
    int32_t width, height;
} header;

static header make_header(const render_film *film, uint64_t fingerprint)
{
    header h = {"hnbrdf-render/1", fingerprint, film->width, film->height};
    return h;
}

static size_t sums_size(const render_film *film)
{
    return (size_t)film->width * (size_t)film->height * sizeof *film->sums;
}

static size_t samples_size(const render_film *film)
{
    return (size_t)film->tiles * sizeof *film->samples;
}

hnbrdf_result render_film_save(const render_film *film, uint64_t fingerprint, const char *path,
                               hnbrdf_error *error)
{
    header h = make_header(film, fingerprint);
    size_t size = sizeof h + samples_size(film) + sums_size(film);
    unsigned char *bytes = malloc(size);
    if (!bytes)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: no memory for its %zu bytes", path,
                           size);
    memcpy(bytes, &h, sizeof h);
    memcpy(bytes + sizeof h, film->samples, samples_size(film));
    memcpy(bytes + sizeof h + samples_size(film), film->sums, sums_size(film));
    hnbrdf_result result = hnbrdf_write_file(path, bytes, size, error);
    free(bytes);
    return result;
}

/* Samples are counts, sums are finite. */
static int is_sound(const render_film *film, const unsigned char *samples,
                    const unsigned char *sums)
{
    for (int i = 0; i < film->tiles; i++) {
        int32_t count;
        memcpy(&count, samples + (size_t)i * sizeof count, sizeof count);
        if (count < 0 || count > 1 << 30)
            return 0;
    }
    for (size_t i = 0; i < sums_size(film); i += sizeof(double)) {
        double sum;
        memcpy(&sum, sums + i, sizeof sum);
        if (!isfinite(sum))
            return 0;
    }
    return 1;
}

hnbrdf_result render_film_decode(const void *data, size_t size, const char *name,
                                 uint64_t fingerprint, render_film *film, hnbrdf_error *error)
{
    const unsigned char *bytes = data;
    header h = make_header(film, fingerprint), found;
    size_t expected = sizeof h + samples_size(film) + sums_size(film);
    if (size < sizeof h || memcmp(bytes, h.magic, sizeof h.magic) != 0)
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: not the state of a rendering by this version", name);
    memcpy(&found, bytes, sizeof found);
    if (found.width != h.width || found.height != h.height)
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: of a picture of %d x %d, expected %d x %d", name, (int)found.width,
                           (int)found.height, film->width, film->height);
    if (found.fingerprint != h.fingerprint)
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: of another scene, or rendered with other options", name);
    if (size != expected)
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: %zu bytes, expected %zu", name, size,
                           expected);
    const unsigned char *samples = bytes + sizeof h, *sums = samples + samples_size(film);
    if (!is_sound(film, samples, sums))
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: damaged: a sum that is not finite",
                           name);
    memcpy(film->samples, samples, samples_size(film));
    memcpy(film->sums, sums, sums_size(film));
    return HNBRDF_OK;
}

hnbrdf_result render_film_load(const char *path, uint64_t fingerprint, render_film *film,
                               hnbrdf_error *error)
{
    render_bytes bytes = {0};
    size_t most = sizeof(header) + samples_size(film) + sums_size(film);
    hnbrdf_result result = render_file_read(path, most, &bytes, error);
    if (result == HNBRDF_OK)
        result = render_film_decode(bytes.data, bytes.size, path, fingerprint, film, error);
    free(bytes.data);
    return result;
}
