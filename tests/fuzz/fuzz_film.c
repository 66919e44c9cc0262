/* fuzz_film.c: the bytes are the state of a rendering to go on from, after magic and fingerprint,
 * which would else refuse them all. What is taken is a film that can be developed. */
#include "fuzz.h"

#include "scene/film.h"

enum { WIDTH = 17, HEIGHT = 2, START = 24 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char magic[16] = "hnbrdf-render/1";
    const uint64_t fingerprint = 7;
    render_film film;
    render_image image;
    hnbrdf_error error = {""};
    unsigned char *bytes = malloc(START + size);
    FUZZ_CHECK(bytes && render_film_create(WIDTH, HEIGHT, &film, NULL) == HNBRDF_OK);
    memcpy(bytes, magic, sizeof magic);
    memcpy(bytes + sizeof magic, &fingerprint, sizeof fingerprint);
    if (size)
        memcpy(bytes + START, data, size);
    const hnbrdf_result result =
        render_film_decode(bytes, START + size, "state", fingerprint, &film, &error);
    if (result)
        fuzz_check_refusal(result, &error);
    for (int i = 0; i < film.tiles; i++)
        FUZZ_CHECK(film.samples[i] >= 0 && (!result || film.samples[i] == 0));
    FUZZ_CHECK(render_film_develop(&film, 1, &image, NULL) == HNBRDF_OK);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        FUZZ_CHECK(!isnan(image.rgb[i]));
    render_image_free(&image);
    render_film_free(&film);
    free(bytes);
    return 0;
}
