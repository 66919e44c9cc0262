/* parent.c MODEL SCRATCH: a program of somebody else's project: its assertions are alive, and a
 * model with a weight that is no number is refused, whatever everything was compiled with. */
#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <hnbrdf/hnbrdf.h>

static int asserted(void)
{
    int alive = 0;
    assert((alive = 1) != 0);
    return alive;
}

int main(int argc, char **argv)
{
    static unsigned char bytes[1 << 22];
    static const unsigned char nan[2][4] = {{0, 0, 0xc0, 0x7f}, {0, 0, 0x80, 0xff}};
    hnbrdf_model *model;
    hnbrdf_error error;
    FILE *file;
    size_t size;
    int k;

    if (argc != 3 || !(file = fopen(argv[1], "rb")))
        return 2;
    size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    if (!asserted()) {
        puts("assert() of the parent is compiled out");
        return 1;
    }
    if (hnbrdf_model_load(argv[1], NULL, &model, &error)) {
        puts(error.text);
        return 1;
    }
    hnbrdf_model_free(model);
    for (k = 0; k < 2; k++) {
        memcpy(bytes + size - 4, nan[k], 4); /* the last number of the last tensor */
        if (!(file = fopen(argv[2], "wb")))
            return 2;
        fwrite(bytes, 1, size, file);
        fclose(file);
        if (hnbrdf_model_load(argv[2], NULL, &model, &error) == HNBRDF_OK) {
            puts(k ? "a weight of minus infinity is taken" : "a weight that is no number is taken");
            return 1;
        }
        puts(error.text);
    }
    return 0;
}
