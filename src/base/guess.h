/* guess.h: what a person may have meant by a word that is not known. */
#ifndef HNBRDF_BASE_GUESS_H
#define HNBRDF_BASE_GUESS_H

#include <stddef.h>

/* Offer every candidate, then ask. */
typedef struct hnbrdf_guess {
    const char *word, *nearest;
    size_t distance;
} hnbrdf_guess;
void hnbrdf_guess_begin(hnbrdf_guess *guess, const char *word);
void hnbrdf_guess_offer(hnbrdf_guess *guess, const char *candidate);
/* The nearest candidate by edit distance if it is near enough to be a slip of the keys, otherwise
 * NULL. */
const char *hnbrdf_guess_nearest(const hnbrdf_guess *guess);

#endif
