/* generate_csv.c: as fuzz_csv.c has it: a byte that says of what, then pairs of directions as CSV
 * from programs and people. */
#include "generate.h"

enum { COLUMNS = 9 };

static void put_field(fuzz_choices *c, fuzz_bytes *out, const char *text)
{
    if (fuzz_below(c, 12) == 0)
        fuzz_put_text(out, FUZZ_PICK(c, char *, " ", "\t"));
    if (fuzz_odd(c))
        fuzz_put_text(out, FUZZ_PICK(c, char *, "\"", "\"a\" b", "\"\"\"", "\"a,b\"", ","));
    fuzz_printf(out, fuzz_below(c, 10) ? "%s" : "\"%s\"", fuzz_word(c, text));
    if (fuzz_below(c, 12) == 0)
        fuzz_put_text(out, FUZZ_PICK(c, char *, " ", "\t "));
}

static void put_direction_part(fuzz_choices *c, fuzz_bytes *out, int column)
{
    fuzz_bytes number = {0};
    double value = column % 3 == 2 ? 0.8 : column % 3 == 0 ? 0.6 : 0.0;
    if (fuzz_below(c, 20) == 0)
        value = fuzz_real_between(c, -1.0, 1.0);
    fuzz_put_number(&number, c, value);
    fuzz_put(&number, "", 1);
    put_field(c, out, (const char *)number.data);
    fuzz_free(&number);
}

static void end_line(fuzz_choices *c, fuzz_bytes *out, const char *end)
{
    if (fuzz_odd(c))
        fuzz_put_text(out, FUZZ_PICK(c, char *, ",", ",,,", " x", "\n", "\n \t\n", "\r"));
    if (fuzz_odd(c))
        for (int k = FUZZ_PICK(c, int, 200, 300, 9000); k > 0; k--)
            fuzz_put_text(out, fuzz_below(c, 100) ? "," : "x");
    if (fuzz_odd(c))
        fuzz_put(out, "", 1);
    fuzz_put_text(out, end);
}

/* Columns in any order: the six, perhaps the material, perhaps one that nobody asked for. */
static int choose_columns(fuzz_choices *c, int columns[COLUMNS], int material)
{
    int count = 6;
    for (int k = 0; k < 6; k++)
        columns[k] = k;
    if (material)
        columns[count++] = 6;
    if (fuzz_below(c, 3) == 0)
        columns[count++] = 7;
    for (int k = count - 1; k > 0; k--) {
        const int other = (int)fuzz_below(c, (unsigned)k + 1), swapped = columns[k];
        columns[k] = columns[other];
        columns[other] = swapped;
    }
    if (fuzz_odd(c))
        columns[fuzz_below(c, (unsigned)count)] = (int)fuzz_below(c, 8);
    if (fuzz_odd(c))
        count--;
    return count;
}

static void generate(fuzz_choices *c, fuzz_bytes *out)
{
    static const char *const names[8] = {"wi_x", "wi_y", "wi_z",     "wo_x",
                                         "wo_y", "wo_z", "material", "note"};
    const unsigned what = fuzz_below(c, 4);
    const int header = what == 1 || fuzz_below(c, 2), lines = fuzz_between(c, 0, 6);
    const char *end = fuzz_below(c, 3) ? "\n" : "\r\n";
    int columns[COLUMNS] = {0, 1, 2, 3, 4, 5}, count = 6;
    fuzz_put_le(out, what, 1);
    if (fuzz_below(c, 6) == 0)
        fuzz_put_text(out, "\xef\xbb\xbf");
    if (header) {
        count = choose_columns(c, columns, what == 1 || fuzz_below(c, 4) == 0);
        for (int k = 0; k < count; k++) {
            fuzz_put_text(out, k ? "," : "");
            put_field(c, out, names[columns[k]]);
        }
        end_line(c, out, end);
    }
    for (int line = 0; line < lines; line++) {
        const int fields = fuzz_odd(c) ? fuzz_between(c, 1, 9) : count;
        for (int k = 0; k < fields; k++) {
            fuzz_put_text(out, k ? "," : "");
            if (k < count && columns[k] >= 6)
                put_field(c, out, columns[k] == 6 && fuzz_below(c, 2) ? "b, \"\"c\"\"" : "a");
            else
                put_direction_part(c, out, k < count ? columns[k] : k);
        }
        end_line(c, out, line + 1 < lines || fuzz_below(c, 2) ? end : "");
    }
}

FUZZ_GENERATOR(generate)
