/* fuzz_film.c: the bytes are the state of a rendering to go on from, of 17 x 2 pixels and
 * fingerprint 7. What is taken is a film that can be developed. */
#include "fuzz.h"

#include "scene/film.h"

#include <sys/mman.h>
#include <unistd.h>

enum { WIDTH = 17, HEIGHT = 2, FINGERPRINT = 7 };

static char path[64]; /* of a file in memory */
static int file;

/* A film is saved and read once, in a folder that is gone afterwards; no film is made of a size
 * that is none. */
static void start(void)
{
    render_film film, read;
    hnbrdf_error error = {""};
    char folder[] = "/tmp/hnbrdf_fuzz_XXXXXX";
    FUZZ_CHECK(mkdtemp(folder) != NULL);
    snprintf(path, sizeof path, "%s/film", folder);
    FUZZ_CHECK(render_film_create(WIDTH, HEIGHT, &film, NULL) == HNBRDF_OK);
    FUZZ_CHECK(render_film_create(WIDTH, HEIGHT, &read, NULL) == HNBRDF_OK);
    film.samples[1] = 3;
    film.sums[16][RENDER_RADIANCE] = 6.0;
    FUZZ_CHECK(render_film_save(&film, FINGERPRINT, path, NULL) == HNBRDF_OK);
    FUZZ_CHECK(render_film_load(path, FINGERPRINT, &read, NULL) == HNBRDF_OK);
    FUZZ_CHECK(memcmp(film.samples, read.samples, 2 * sizeof *film.samples) == 0 &&
               memcmp(film.sums, read.sums, WIDTH * HEIGHT * sizeof *film.sums) == 0);
    render_film_free(&film);
    render_film_free(&read);
    remove(path);
    rmdir(folder);
    fuzz_check_refusal(render_film_create(0, HEIGHT, &film, &error), &error);
    file = memfd_create("fuzz", 0);
    FUZZ_CHECK(file >= 0);
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
}

static void check_film(const render_film *film, int is_read)
{
    render_image image = {0};
    for (int i = 0; i < film->tiles; i++)
        FUZZ_CHECK(film->samples[i] >= 0 && (is_read || film->samples[i] == 0));
    for (int layers = 0; layers < 2; layers++) {
        FUZZ_CHECK(render_film_develop(film, layers, &image, NULL) == HNBRDF_OK);
        for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
            FUZZ_CHECK(!isnan(image.rgb[i]));
        render_image_free(&image);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    render_film film;
    hnbrdf_error error = {""};
    if (!path[0])
        start();
    FUZZ_CHECK(ftruncate(file, 0) == 0 && pwrite(file, data, size, 0) == (ssize_t)size);
    FUZZ_CHECK(render_film_create(WIDTH, HEIGHT, &film, NULL) == HNBRDF_OK);
    const hnbrdf_result result = render_film_load(path, FINGERPRINT, &film, &error);
    if (result)
        fuzz_check_refusal(result, &error);
    check_film(&film, result == HNBRDF_OK);
    render_film_free(&film);
    return 0;
}
