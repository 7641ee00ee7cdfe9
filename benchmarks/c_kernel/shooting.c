/* Shooting for a cycle of van der Pol's oscillator as a block on a spring: Newton's iteration on the load where the slip rate passes
   the pull rate, with the equation of disturbances, by RK4 with a fixed number of steps in a period. cycle.py compiles it. */

#include <math.h>

#define PULL 1.0
#define SCALE 0.4
#define UNKNOWNS 6

static void paces(const double *y, double *d) {
    const double x = (y[1] - PULL) / SCALE;
    const double slope = -(x * x - 1.0);
    d[0] = PULL - y[1];
    d[1] = y[0] - (5.0 + SCALE * (x * x * x / 3.0 - x));
    for (int k = 2; k < UNKNOWNS; k += 2) {
        d[k] = -y[k + 1];
        d[k + 1] = y[k] + slope * y[k + 1];
    }
}

static void one_period(double *y, double period, int steps) {
    double a[UNKNOWNS], b[UNKNOWNS], c[UNKNOWNS], d[UNKNOWNS], at[UNKNOWNS];
    const double h = period / steps;
    for (int n = 0; n < steps; n++) {
        paces(y, a);
        for (int k = 0; k < UNKNOWNS; k++) at[k] = y[k] + 0.5 * h * a[k];
        paces(at, b);
        for (int k = 0; k < UNKNOWNS; k++) at[k] = y[k] + 0.5 * h * b[k];
        paces(at, c);
        for (int k = 0; k < UNKNOWNS; k++) at[k] = y[k] + h * c[k];
        paces(at, d);
        for (int k = 0; k < UNKNOWNS; k++) y[k] += h / 6.0 * (a[k] + 2.0 * (b[k] + c[k]) + d[k]);
    }
}

/* found: load and period, first as guesses; then the multiplier behind them. Returns the number of periods that were run. */
int shoot(double *found, int steps, int most) {
    for (int n = 1; n <= most; n++) {
        double y[UNKNOWNS] = {found[0], PULL, 1.0, 0.0, 0.0, 1.0}, pace[UNKNOWNS];
        one_period(y, found[1], steps);
        paces(y, pace);
        const double miss = y[0] - found[0], late = y[1] - PULL;
        /* the load and the period change so that both misses vanish */
        const double a = y[2] - 1.0, b = pace[0], c = y[3], d = pace[1], over = a * d - b * c;
        found[2] = y[2] - pace[0] / pace[1] * y[3];
        if (fabs(miss) + fabs(late) < 1e-11) return n;
        found[0] -= (d * miss - b * late) / over;
        found[1] -= (a * late - c * miss) / over;
    }
    return -1;
}
