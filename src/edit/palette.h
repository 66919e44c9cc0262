/* palette.h: a model's materials as a list that can be changed, and saved with the model's
 * network. */
#ifndef HNBRDF_EDIT_PALETTE_H
#define HNBRDF_EDIT_PALETTE_H

#include "cli/cli.h"

typedef struct palette {
    hnbrdf_model *model;
    const char *path;           /* of the model's file */
    hnbrdf_material *materials; /* [count] */
    char **names;
    int count;
} palette;

/* Loads a model file. All return 0, or CLI_FAILURE after a message. */
int palette_open(palette *p, const char *path);
/* A material under a new name at the end of the list, or in place of the one of this name if
 * `replace`; otherwise a name that is taken is an error. The values are checked; the lobes are
 * fitted anew. */
int palette_put(palette *p, const char *name, const hnbrdf_material *material, int replace);
/* Writes network and materials; path may be the file they came from. */
int palette_save(const palette *p, const char *path);
void palette_close(palette *p);

#endif
