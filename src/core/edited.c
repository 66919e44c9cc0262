/* edited.c: f of one pair of an edited material: carry.h around the network of the model's
 * kernel. */
#include "core/encoding.h"
#include "core/kernel.h"
#include "core/prepared.h"

void hnbrdf_edited_eval(const hnbrdf_prepared *prepared, const float wi[3], const float wo[3],
                        float f[3])
{
    const hnbrdf_model *model = prepared->model;
    const hnbrdf_model_desc *desc = &model->desc;
    float edited[4], fitted[4], out[HNBRDF_MAX_HIDDEN], x[HNBRDF_ENCODING_SIZE];
    hnbrdf_pair pair = hnbrdf_pair_in_frame(prepared, wi, wo);
    hnbrdf_pair seen = hnbrdf_prepared_edited(prepared, &pair, edited, fitted);
    hnbrdf_encode(desc->encoding, &seen, x);
    model->kernel->outputs(prepared, x, out);
    for (int c = 0; c < 3; c++)
        f[c] =
            hnbrdf_compose_edited(out[c], out[c + 3], edited[c], fitted[c], prepared->edit.added[c],
                                  desc->scale, desc->shift, desc->floor);
}
