/* soap.h: a step of a layer's weights: Adam in the eigenbases of its gradients (SOAP: Vyas et al.
 * 2024; after Shampoo, Gupta et al. 2018).
 *
 * The weights and the bias of a layer are one matrix, inputs by outputs, and so is its gradient G.
 * Running means of G G^T and G^T G say which combinations of inputs and of outputs vary together.
 * Adam's squares, and its step, are taken of the gradient turned into their eigenvectors, in which
 * the loss is far nearer to a sum over single numbers. Every few steps one step of subspace
 * iteration follows the eigenvectors.
 *
 * Sums have one order: the same bits on every machine. */
#ifndef HNBRDF_FIT_SOAP_H
#define HNBRDF_FIT_SOAP_H

#include "fit/kernel.h"

enum { FIT_SOAP_SQUARES = 7 };

/* One layer: where its numbers lie. */
typedef struct fit_soap_layer {
    int inputs, outputs;      /* inputs: with the bias, the last */
    size_t at;                /* in places: [inputs][outputs] */
    size_t left, right;       /* in state: the means [inputs]^2 and [outputs]^2 */
    size_t left_basis;        /* in state: eigenvectors, one a row */
    size_t right_basis, room; /* likewise; in room: FIT_SOAP_SQUARES of the longer side */
} fit_soap_layer;

typedef struct fit_soap {
    fit_soap_layer layers[HNBRDF_MAX_LAYERS + 1];
    int count;
    const fit_kernel *kernel;
    size_t *places; /* of all weights in the layout */
    /* [state_count] the means and bases of all layers: with Adam's moments, all there is to know */
    float *state;
    size_t state_count;
    float *room;
} fit_soap;

/* 0 where memory is out; nothing for a layout without a network. */
int hnbrdf_fit_soap_make(fit_soap *soap, const fit_layout *layout, const fit_kernel *kernel);
void hnbrdf_fit_soap_free(fit_soap *soap);

/* One step of layer k, which may run beside those of others; step counts from 1, which starts anew.
 * m and v lie like parameters, zero before the first step. A gradient beyond 1e17 leaves the layer
 * alone. */
void hnbrdf_fit_soap_step(const fit_soap *soap, int k, float *parameters, const float *gradient,
                          float *m, float *v, long step, double rate);

#endif
