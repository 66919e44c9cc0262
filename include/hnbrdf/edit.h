/* edit.h: models with other materials: replaced, added, removed, renamed, lobes fitted again; and
 * the way from one material to another.
 *
 * A model never changes; an edit makes a new one beside it. The network is copied bit by bit, so
 * materials that no change names keep their values to the last bit. Part of libhnbrdf; needs
 * nothing else and starts no threads. To change a material, copy it from the model, edit its
 * fields (or mix two, hnbrdf_mix_path_fit()) and put it back with HNBRDF_CHANGE_REPLACE. */
#ifndef HNBRDF_EDIT_H
#define HNBRDF_EDIT_H

#include "hnbrdf/hnbrdf.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What one change does. */
typedef enum hnbrdf_change_kind {
    HNBRDF_CHANGE_PUT = 0, /* add, or replace where the name is taken */
    HNBRDF_CHANGE_ADD,     /* at the end; the name must be new */
    HNBRDF_CHANGE_REPLACE, /* in its place; the name must be there */
    HNBRDF_CHANGE_REMOVE,  /* those behind it move up by one */
    HNBRDF_CHANGE_RENAME,  /* in its place; new_name must be free, or the name itself */
    HNBRDF_CHANGE_LOBES    /* its sampling lobes alone; name NULL: those of every material */
} hnbrdf_change_kind;

/* The sampling lobes that a material gets. Only HNBRDF_LOBES_FIT takes time, some tens of
 * milliseconds a material. */
typedef enum hnbrdf_lobes_scheme {
    HNBRDF_LOBES_KEEP = 0, /* those of `material`, or those that are there */
    HNBRDF_LOBES_FIT,      /* hnbrdf_lobes_fit(): least variance */
    HNBRDF_LOBES_PAPER,    /* hnbrdf_lobes_paper(): to compare with */
    HNBRDF_LOBES_GUESS     /* none: hnbrdf_sample() guesses from kd and eta */
} hnbrdf_lobes_scheme;

/* Zero-initialise. The pointers need to live for the call only. */
typedef struct hnbrdf_material_change {
    hnbrdf_change_kind kind;
    const char *name;                /* of the material */
    const hnbrdf_material *material; /* PUT, ADD, REPLACE: passes hnbrdf_material_check() */
    const char *new_name;            /* RENAME */
    hnbrdf_lobes_scheme lobes;       /* PUT, ADD, REPLACE, LOBES */
} hnbrdf_material_change;

/* Zero-initialise for defaults. */
typedef struct hnbrdf_edit_options {
    /* memory for the new model and for the work; fitting lobes takes that of `model` */
    hnbrdf_allocator allocator;
    /* if set: called after every change and every fitted lobe, share from 0 to 1, with the name
     * of the material; anything but 0 stops with HNBRDF_ERROR_CANCELLED */
    int (*progress)(void *user, double share, const char *name);
    void *progress_user;
} hnbrdf_edit_options;

/* The model with these changes, made in order, each seeing what those before it left. Names stay
 * unique and legal after every change (as in hnbrdf_model_desc); a name that is not there or is
 * taken, a material out of range, a limit passed or no material left at the end are errors, and
 * the message names the material. The network, the constants and the variant are those of
 * `model`, which stays as it is and need not outlive *out. Without changes *out is a copy. options
 * may be NULL; *out is untouched on failure. */
HNBRDF_EXPERIMENTAL hnbrdf_result hnbrdf_model_with_materials(
    const hnbrdf_model *model, const hnbrdf_material_change *changes, int count,
    const hnbrdf_edit_options *options, hnbrdf_model **out, hnbrdf_error *error);

/* Changes a material as a text says: assignments FIELD=VALUE with commas between, made in order.
 * FIELD is kd or eta (one value or three, R:G:B), alpha (one or two, x:y), alpha_x, alpha_y or
 * rotation (radians, or with a unit as in 30deg). FIELD*=VALUE multiplies, FIELD+=VALUE adds,
 * FIELD=fitted takes an edit of kd, eta or alpha back; HNBRDF_ERROR_ARGUMENT where material->fitted
 * is all zeros. "alpha=0.1:0.4,kd*=0.5". Numbers are decimal, with '.' whatever the locale. What
 * comes out may be out of range: hnbrdf_material_check() tells, and so does the function above.
 * Untouched on failure. */
HNBRDF_EXPERIMENTAL hnbrdf_result hnbrdf_material_set(hnbrdf_material *material, const char *text,
                                                      hnbrdf_error *error);

/* ---- Mixing ----------------------------------------------------------------------------------
 * hnbrdf_material_mix() goes straight through the latent space, where what lies between two
 * materials may look like neither: between a yellow and a blue paint a pink one. A path goes
 * around. Each of its places is as near as the network comes to this: both ends, edited to kd, eta
 * and alpha of the straight mixture (as hnbrdf_material_set() would), their values blended in the
 * logarithm; with a directional albedo, seen from 0, 30 and 60 degrees, that stays in every
 * channel between those of the ends, a few per cent aside (more where the network leaves no other
 * way). `hnbrdf report editing` measures both.
 *
 * A path is HNBRDF_MIX_KNOTS materials at t = 0, 1/32, ... 1, the first and the last being the
 * ends, with the straight way between neighbours. So it is continuous, and every material on it is
 * legal. Its materials count as edited (hnbrdf_material_is_edited()): kd, eta, alpha and fitted
 * are near those of the straight mixture, but free. */
#define HNBRDF_MIX_KNOTS 33 /* materials of a path */

/* Finds a path from a to b, two legal materials, which need not belong to the model. Always the
 * same bits for the same ends; a tenth of a second for a network of 32x2, so keep it while somebody
 * walks on it. A GGX model has no network to go astray: its path is the straight line. In a neural
 * model only the latent code can move. The lobes are those of the straight mixture; fit
 * them again where samples count. Memory comes from the model's allocator. path is untouched on
 * failure, and may hold a or b. */
HNBRDF_EXPERIMENTAL hnbrdf_result hnbrdf_mix_path_fit(const hnbrdf_model *model,
                                                      const hnbrdf_material *a,
                                                      const hnbrdf_material *b,
                                                      hnbrdf_material path[HNBRDF_MIX_KNOTS],
                                                      hnbrdf_error *error);

/* The material on the path at t: at t <= 0 (or NaN) a and at t >= 1 b, bit by bit. Cannot fail.
 * out may be one of the path. */
HNBRDF_EXPERIMENTAL void hnbrdf_mix_path_at(const hnbrdf_material path[HNBRDF_MIX_KNOTS], float t,
                                            hnbrdf_material *out);

#ifdef __cplusplus
}
#endif

#endif
