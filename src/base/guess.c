/* guess.c: what a person may have meant by a word that is not known. */
#include "base/guess.h"

#include "hnbrdf/hnbrdf.h"

#include <string.h>

static size_t min3(size_t a, size_t b, size_t c)
{
    size_t ab = a < b ? a : b;
    return ab < c ? ab : c;
}

/* Insertions, deletions, substitutions and swaps of neighbours from a to b, each part taken once
 * (optimal string alignment), of their first HNBRDF_MAX_NAME bytes. */
static size_t edit_distance(const char *a, const char *b)
{
    enum { SIZE = HNBRDF_MAX_NAME + 1 };
    size_t rows[3][SIZE], *before = rows[0], *above = rows[1], *row = rows[2];
    size_t length_a = strlen(a), length_b = strlen(b);
    length_a = length_a < SIZE ? length_a : SIZE - 1;
    length_b = length_b < SIZE ? length_b : SIZE - 1;
    for (size_t j = 0; j <= length_b; j++)
        row[j] = j;
    for (size_t i = 1; i <= length_a; i++) {
        size_t *oldest = before;
        before = above;
        above = row;
        row = oldest;
        row[0] = i;
        for (size_t j = 1; j <= length_b; j++) {
            row[j] = min3(above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] != b[j - 1]));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = min3(row[j], before[j - 2] + 1, row[j]);
        }
    }
    return row[length_b];
}

void hnbrdf_guess_begin(hnbrdf_guess *guess, const char *word)
{
    guess->word = word;
    guess->nearest = NULL;
    guess->distance = 0;
}

void hnbrdf_guess_offer(hnbrdf_guess *guess, const char *candidate)
{
    size_t distance = edit_distance(guess->word, candidate);
    /* The beginning of a name is most often what was meant. */
    size_t length = strlen(guess->word);
    if (length >= 3 && strncmp(guess->word, candidate, length) == 0)
        distance = 1;
    if (!guess->nearest || distance < guess->distance) {
        guess->nearest = candidate;
        guess->distance = distance;
    }
}

const char *hnbrdf_guess_nearest(const hnbrdf_guess *guess)
{
    return guess->nearest && guess->distance <= 1 + strlen(guess->word) / 4 ? guess->nearest : NULL;
}
