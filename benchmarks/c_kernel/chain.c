/* A chain of blocks under Coulomb friction, forward slip only, from one event to the next: series of the moving blocks, and the
   first root of a slip rate or of a load less its strength, found by samples and halving. Nothing is proven, and a pair of roots
   between two samples is missed. Masses, springs to the plate and normal loads are 1. */

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#define ORDER 22   /* (6.4 * LONGEST)^22 / 22! is below 2e-15 for the highest frequency of a coupling of 10 */
#define LONGEST 0.3
#define HALVINGS 60

typedef struct {
    int64_t count;
    double pull, coupling, strong, weak;
} Chain;

static double value(const double *a, double s) {
    double sum = 0.0;
    for (int k = ORDER; k >= 0; k--) sum = sum * s + a[k];
    return sum;
}

static double slope(const double *a, double s) {
    double sum = 0.0;
    for (int k = ORDER; k >= 1; k--) sum = sum * s + k * a[k];
    return sum;
}

/* Order k of the force of all springs on block j, at the time t. */
static double force(const Chain *c, double (*a)[ORDER + 1], int64_t j, int k, double t) {
    double f = (k == 0 ? c->pull * t : k == 1 ? c->pull : 0.0) - a[j][k];
    if (j > 0) f += c->coupling * (a[j - 1][k] - a[j][k]);
    if (j < c->count - 1) f += c->coupling * (a[j + 1][k] - a[j][k]);
    return f;
}

/* How far block j is from its event: its slip rate if it moves, else its strength less its load. */
static double room(const Chain *c, double (*a)[ORDER + 1], const double *load, int64_t j, int moves, double s) {
    return moves ? slope(a[j], s) : c->strong - value(load, s);
}

/* Solve a chain until `duration`, with so many samples of a step; u has the slip at the start, and at the end. Returns the number of
   onsets. */
int64_t solve(int64_t count, int64_t samples, double pull, double coupling, double strong, double weak, double duration, double *u) {
    Chain c = {count, pull, coupling, strong, weak};
    double(*a)[ORDER + 1] = calloc(count, sizeof *a), *v = calloc(count, sizeof *v), load[ORDER + 1];
    char *moves = calloc(count, 1);
    double t = 0.0;
    int64_t onsets = 0;
    for (int64_t j = 0; j < count; j++) a[j][0] = u[j];
    for (int64_t j = 0; j < count; j++) onsets += moves[j] = force(&c, a, j, 0, 0.0) > strong;
    while (t < duration) {
        double step = LONGEST;
        int64_t event = -1, moving = 0;
        for (int64_t j = 0; j < count; j++) moving += moves[j];
        if (!moving) step = duration - t;
        for (int k = 0; k + 2 <= ORDER; k++)
            for (int64_t j = 0; j < count; j++)
                if (moves[j]) a[j][k + 2] = (force(&c, a, j, k, t) - (k == 0 ? weak : 0.0)) / ((k + 1.0) * (k + 2.0));
        if (step > duration - t) step = duration - t;
        for (int64_t j = 0; j < count; j++) {
            int alone = !moves[j] && !(j > 0 && moves[j - 1]) && !(j < count - 1 && moves[j + 1]);
            double now = alone || !moves[j] ? force(&c, a, j, 0, t) : 0.0;
            if (alone) { /* its load grows with the pull alone */
                double until = fmax(strong - now, 0.0) / pull;
                if (until < step) step = until, event = j;
                continue;
            }
            if (!moves[j])
                for (int k = 0; k <= ORDER; k++) load[k] = force(&c, a, j, k, t);
            for (int64_t i = 1; i <= samples; i++) {
                double high = step * i / samples, low = step * (i - 1) / samples;
                if (room(&c, a, load, j, moves[j], high) > 0.0) continue;
                for (int n = 0; n < HALVINGS; n++) {
                    double middle = 0.5 * (low + high);
                    if (room(&c, a, load, j, moves[j], middle) > 0.0) low = middle; else high = middle;
                }
                step = high, event = j;
                break;
            }
        }
        for (int64_t j = 0; j < count; j++) {
            if (!moves[j]) continue;
            v[j] = slope(a[j], step);
            u[j] = value(a[j], step);
            for (int k = 2; k <= ORDER; k++) a[j][k] = 0.0;
            a[j][0] = u[j], a[j][1] = v[j];
        }
        t += step;
        if (event >= 0) {
            onsets += !moves[event];
            moves[event] = !moves[event];
            v[event] = a[event][1] = 0.0;
        }
    }
    free(a), free(v), free(moves);
    return onsets;
}
