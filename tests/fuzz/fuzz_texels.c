/* fuzz_texels.c: a packing and texels from anywhere. Whatever the bits, a packing that passes its
 * check gives materials that pass theirs, and packing what was unpacked stays within the texels. */
#include "fuzz.h"

/* The next float of the bytes, which never run out. */
typedef struct source {
    const uint8_t *data;
    size_t size, at;
} source;

static void take(source *s, void *value, size_t size)
{
    unsigned char *bytes = value;
    for (size_t i = 0; i < size; i++)
        bytes[i] = s->size ? s->data[s->at++ % s->size] : 0;
}

static void take_range(source *s, float range[2])
{
    take(s, range, 2 * sizeof *range);
}

static hnbrdf_packing take_packing(source *s)
{
    uint8_t head[2];
    hnbrdf_packing packing = {.format = HNBRDF_TEXEL_RGBA16F};
    take(s, head, sizeof head);
    packing.format = (hnbrdf_texel_format)(head[0] & 1);
    packing.analytic = head[0] >> 1 & 1;
    packing.anisotropic = head[0] >> 2 & 1;
    packing.rotated = head[0] >> 3 & 1;
    packing.lobes = head[0] >> 5 & 1;
    packing.energy = head[0] >> 6 & 1;
    packing.latent = head[1] % (HNBRDF_MAX_LATENT + 2) - 1;
    if (head[0] & 16) { /* ranges as a fit has them; else any floats */
        packing.kd[1] = 1.0f;
        packing.eta[0] = 1.001f;
        packing.eta[1] = 3.5f;
        packing.alpha[0] = HNBRDF_MIN_ALPHA;
        packing.alpha[1] = 1.0f;
    } else {
        take_range(s, packing.kd);
        take_range(s, packing.eta);
        take_range(s, packing.alpha);
    }
    for (int i = 0; i < packing.latent && i < HNBRDF_MAX_LATENT; i++)
        take_range(s, packing.latent_range[i]);
    return packing;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    source s = {data, size, 0};
    const hnbrdf_packing packing = take_packing(&s);
    hnbrdf_error error = {""};
    hnbrdf_material material;
    float channels[4 * HNBRDF_MAX_TEXELS];
    const hnbrdf_result result = hnbrdf_packing_check(&packing, &error);
    if (result) {
        fuzz_check_refusal(result, &error);
        return 0;
    }
    const int texels = hnbrdf_packing_texels(&packing);
    FUZZ_CHECK(texels >= 1 && texels <= HNBRDF_MAX_TEXELS);
    const size_t bytes = (size_t)texels * hnbrdf_texel_bytes(packing.format);
    unsigned char *packed = malloc(bytes), *again = malloc(bytes);
    FUZZ_CHECK(packed != NULL && again != NULL);
    take(&s, packed, bytes);
    hnbrdf_material_unpack(&packing, packed, &material);
    FUZZ_CHECK(hnbrdf_material_check(&material, NULL) == HNBRDF_OK);
    hnbrdf_material_pack(&packing, &material, again);
    hnbrdf_material_unpack(&packing, again, &material);
    FUZZ_CHECK(hnbrdf_material_check(&material, NULL) == HNBRDF_OK);
    take(&s, channels, sizeof channels);
    hnbrdf_material_unpack_channels(&packing, channels, &material);
    FUZZ_CHECK(hnbrdf_material_check(&material, NULL) == HNBRDF_OK);
    free(packed);
    free(again);
    return 0;
}
