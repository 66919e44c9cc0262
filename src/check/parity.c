/* parity.c: rows of inputs and outputs of shaders/parity.glsl, which says what is where. */
#include "check/parity.h"

#include <string.h>

void check_parity_rows(const check_reference *reference, int material,
                       float (*rows)[CHECK_PARITY_INPUTS])
{
    for (size_t k = 0; k < reference->count; k++) {
        float *row = rows[k];
        row[0] = (float)material;
        memcpy(row + 1, reference->pairs + 6 * k, 6 * sizeof *row);
        memcpy(row + 7, reference->u + 2 * k, 2 * sizeof *row);
        row[9] = 0.0f;
        memcpy(row + 10, reference->stages[CHECK_STAGE_ENCODING] + 6 * k, 6 * sizeof *row);
    }
}

/* Where a stage begins in a row of outputs, in groups of up to three. */
typedef struct place {
    check_stage stage;
    int to, from, count;
} place;

int check_parity_stages(const float (*outputs)[CHECK_PARITY_OUTPUTS], size_t count,
                        float *const stages[CHECK_STAGES])
{
    static const place places[] = {
        {CHECK_STAGE_ENCODING, 0, 0, 3},  {CHECK_STAGE_ENCODING, 3, 4, 3},
        {CHECK_STAGE_NETWORK, 0, 8, 3},   {CHECK_STAGE_NETWORK, 3, 12, 3},
        {CHECK_STAGE_ANALYTIC, 0, 16, 3}, {CHECK_STAGE_DENSITY, 1, 19, 1},
        {CHECK_STAGE_VALUE, 0, 20, 3},    {CHECK_STAGE_DIRECTION, 0, 24, 3},
        {CHECK_STAGE_DENSITY, 0, 27, 1},  {CHECK_STAGE_WEIGHT, 0, 28, 3}};
    int ordered = count > 0;
    for (size_t k = 0; k < count; k++) {
        for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
            const place *p = &places[i];
            memcpy(stages[p->stage] + k * (size_t)check_stage_stride(p->stage) + p->to,
                   outputs[k] + p->from, (size_t)p->count * sizeof(float));
        }
        ordered = ordered && outputs[k][31] == 1.0f;
    }
    return ordered;
}
