/* The engine's algorithm in C: one Taylor step after the other, cut at the first event.

   It works in the same memory as the engine (`stickslip.engine.state.workspace.Run`) and writes the same history. `law.h`
   (the records and codes of the engine, and the law's `value` and `jet` from the same recurrences) is written by `benchmarks.c_peer`.
   Left out, since the benchmark's problems do not meet them: folds reached from a slipping branch, knots of a law, leaps, and what
   is done where a step turns out to be wrong: that it is not is verified at the end of every step, as in the engine. */

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "law.h"

#define NONE INFINITY
#define TIE 1e-13
#define LOW 9

typedef struct {
    const Params *params;
    const double *c;
    const LawPiece *law;
    const BranchRow *branch;
    const FirstLoad *first_load;
    State *state;
    Counts *count;
    HistoryPiece *history;
    int64_t branches, loads, capacity;
    double load[TERMS], local[TERMS], load_along_slip[TERMS], jet[2 * TERMS], powers[TERMS];
    LawValue value;
    Friction friction;
    SeriesInput k;
    Ball ball;
} Run;

static double reciprocal[2 * TERMS], bernstein[TERMS][TERMS], low_bernstein[LOW][LOW];

static double choose(int n, int k) { return round(exp(lgamma(n + 1.0) - lgamma(k + 1.0) - lgamma(n - k + 1.0))); }

void prepare_tables(void) {
    for (int k = 1; k < 2 * TERMS; k++) reciprocal[k] = 1.0 / k;
    for (int k = 0; k < TERMS; k++)
        for (int j = k; j < TERMS; j++) bernstein[k][j] = choose(j, k) / choose(TERMS - 1, k);
    for (int k = 0; k < LOW; k++)
        for (int j = k; j < LOW; j++) low_bernstein[k][j] = choose(j, k) / choose(LOW - 1, k);
}

/* ---- polynomials ---------------------------------------------------------------------------------------------------------- */

static double evaluate(const double *c, double x) {
    double value = c[TERMS - 1];
    for (int k = TERMS - 2; k >= 0; k--) value = value * x + c[k];
    return value;
}

static double total(const double *c) {
    double even = 0.0, odd = 0.0;
    for (int k = 0; k + 1 < TERMS; k += 2) even += c[k], odd += c[k + 1];
    return even + odd + (TERMS % 2 ? c[TERMS - 1] : 0.0);
}

static double magnitude(const double *c) {
    double even = 0.0, odd = 0.0;
    for (int k = 1; k + 1 < TERMS; k += 2) even += fabs(c[k]), odd += fabs(c[k + 1]);
    return even + odd + (TERMS % 2 ? 0.0 : fabs(c[TERMS - 1]));
}

static double slope_magnitude(const double *c) {
    double sum = 0.0;
    for (int k = 2; k < TERMS; k++) sum += k * fabs(c[k]);
    return sum;
}

static double integral(const double *c, int shift) {
    double even = 0.0, odd = 0.0;
    for (int k = 0; k + 1 < TERMS; k += 2) even += reciprocal[k + shift] * c[k], odd += reciprocal[k + 1 + shift] * c[k + 1];
    return even + odd + (TERMS % 2 ? reciprocal[TERMS - 1 + shift] * c[TERMS - 1] : 0.0);
}

static void powers_of(double x, double *out) {
    out[0] = 1.0, out[1] = x;
    for (int k = 2; k < TERMS; k++) out[k] = out[k >> 1] * out[(k + 1) >> 1];
}

static int degree(const double *c) {
    int n = TERMS - 1;
    while (n > 0 && c[n] == 0.0) n--;
    return n;
}

static void restrict_low(const double *c, int n, double start, double width, double *out) {
    memcpy(out, c, (n + 1) * sizeof(double));
    if (start != 0.0)
        for (int j = 0; j < n; j++)
            for (int k = n - 1; k >= j; k--) out[k] += start * out[k + 1];
    double power = width;
    for (int k = 1; k <= n; k++, power *= width) out[k] *= power;
}

static void restrict_to(const double *c, double start, double width, double *out) {
    int n = degree(c);
    for (int k = n + 1; k < TERMS; k++) out[k] = 0.0;
    restrict_low(c, n, start, width, out);
}

static double falling_root(const double *c) {
    double low = -1.0, high = 1.0, x = 0.0;
    for (int i = 0; i < 100; i++) {
        double value = c[TERMS - 1], slope = 0.0;
        for (int k = TERMS - 2; k >= 0; k--) slope = slope * x + value, value = value * x + c[k];
        if (value > 0.0) low = x;
        else if (value < 0.0) high = x;
        else return x;
        double step = slope < 0.0 ? x - value / slope : 0.5 * (low + high);
        if (!(low < step && step < high)) step = 0.5 * (low + high);
        if (step == x || high - low < 1e-17) return x;
        x = step;
    }
    return x;
}

static double isolate(const double *q) {
    double part[TERMS], start = 0.0, width = 1.0;
    while (start < 1.0) {
        restrict_to(q, start + 0.5 * width, 0.5 * width, part);
        double tail = magnitude(part), slope_tail = slope_magnitude(part);
        if (part[0] < -tail || (width < 1e-15 && part[0] < 0.0)) return start;
        if (-part[1] > slope_tail && total(part) <= 0.0) return start + 0.5 * width * (1.0 + falling_root(part));
        int clear = part[0] > tail || -part[1] > slope_tail || (part[1] > slope_tail && evaluate(part, -1.0) >= 0.0);
        if (clear || width < 1e-15) {
            start += width;
            while (start < 1.0 && floor(start / (2.0 * width)) * 2.0 * width == start) width *= 2.0;
        } else width *= 0.5;
    }
    return NONE;
}

static int clearly_positive(const double *c) {
    double rest = 0.0;
    for (int k = LOW; k < TERMS; k++) rest += fabs(c[k]);
    for (int j = 1; j < LOW; j++) {
        double coefficient = c[0];
        for (int k = 1; k <= j; k++) coefficient += low_bernstein[k][j] * c[k];
        if (coefficient <= rest) return 0;
    }
    return 1;
}

static double first_descent(const double *c) {
    int lead = 0;
    while (lead < TERMS - 1 && c[lead] == 0.0) lead++;
    if (c[lead] < 0.0) return 0.0;
    if (c[lead] == 0.0) return NONE;
    double bound = 0.0, q[TERMS];
    for (int k = lead + 1; k < TERMS; k++) bound += fabs(c[k]);
    if (c[lead] > bound || (lead == 0 && clearly_positive(c))) return NONE;
    for (int j = 0; j < TERMS; j++) q[j] = c[lead];
    for (int k = lead + 1; k < TERMS; k++)
        for (int j = 0; j < TERMS; j++) q[j] += bernstein[k - lead][j] * c[k];
    double lowest = q[0];
    for (int j = 1; j < TERMS; j++) lowest = fmin(lowest, q[j]);
    if (lowest > 0.0) return NONE;
    for (int k = 0; k < TERMS; k++) q[k] = k + lead < TERMS ? c[k + lead] : 0.0;
    return isolate(q);
}

/* ---- the contact ---------------------------------------------------------------------------------------------------------- */

static void friction_at(Run *r, double slip, double rate) {
    value(r->c, slip + r->law->slip_shift, rate, (double *)&r->value);
    r->friction.coefficient = r->value.mu + r->law->offset;
    r->friction.stress = r->params->normal * r->friction.coefficient;
    r->friction.by_rate = r->value.by_rate * r->params->normal;
}

static double rest_limit(Run *r) {
    friction_at(r, r->state->law_slip, 0.0);
    return r->params->normal * (r->friction.coefficient + r->params->static_excess) + r->params->stick_to;
}

static double towards(Run *r, double load, int64_t direction) { return direction > 0 ? load : -load - 2.0 * r->params->reference; }

static double rate_on_branch(Run *r, double load, double guess) {
    int64_t branch = r->count->branch;
    double low = r->branch[branch].rate_from, high = r->branch[branch].rate_to;
    if (load <= r->branch[branch].excess_from) return low;
    if (load >= r->branch[branch].excess_to) return high;
    high = fmin(high, (load + r->params->largest_drop) / r->params->damping * (1.0 + 1e-12));
    double s = low < guess && guess < high ? guess : 0.5 * (low + high);
    for (int i = 0; i < 200; i++) {
        friction_at(r, r->state->law_slip, s);
        double error = r->params->damping * s + r->friction.stress - load, slope = r->params->damping + r->friction.by_rate;
        if (error > 0.0) high = s;
        else if (error < 0.0) low = s;
        else return s;
        double step = slope > 0.0 ? s - error / slope : 0.5 * (low + high);
        if (!(low < step && step < high) && step != s) step = 0.5 * (low + high);
        if (fabs(step - s) <= 1e-16 * fabs(s) || step == low || step == high) return step;
        s = step;
    }
    return s;
}

static void choose_branch(Run *r, double load) {
    r->state->exit = NAN;
    for (int64_t branch = 0; branch < r->branches; branch++)
        if (load <= r->branch[branch].keep_to) { r->count->branch = branch; return; }
}

static void leave_branch(Run *r, double load) {
    int64_t branch = r->count->branch;
    r->state->exit = NAN;
    if (load >= r->branch[branch].keep_to)
        for (int64_t other = branch + 1; other < r->branches; other++)
            if (load <= r->branch[other].keep_to) { r->count->branch = other; return; }
    for (int64_t other = branch - 1; other >= 0; other--)
        if (r->branch[other].keep_from <= load) { r->count->branch = other; return; }
    r->count->mode = 0;
}

static void note_jump(Run *r, double rate, int64_t cause) {
    double before = r->state->rate_now, size = fabs(rate - before);
    if (size > r->params->smallest_jump && size > r->params->relative_jump * fmax(fabs(rate), fabs(before)))
        r->count->cause = cause, r->count->jump = 1;
}

static double branch_exit(Run *r) {
    int64_t branch = r->count->branch, mode = r->count->mode;
    double part[TERMS], xi = r->state->xi, first = NONE;
    for (int upper = 0; upper < 2; upper++) {
        double bound = upper ? r->branch[branch].keep_to : r->branch[branch].keep_from, sign = upper ? -1.0 : 1.0;
        if (isinf(bound)) continue;
        restrict_to(r->load, xi, 1.0 - xi, part);
        double start = sign * (towards(r, part[0], mode) - bound);
        for (int k = 0; k < TERMS; k++) part[k] *= sign * mode;
        part[0] = r->count->leaving_rest != 0 && start < 0.0 ? 0.0 : start;
        first = fmin(first, first_descent(part));
    }
    return first < 1.0 - TIE ? xi + first * (1.0 - xi) : NONE;
}

static void end_branch(Run *r) {
    int64_t branch = r->count->branch, direction = r->count->mode;
    double seen = towards(r, evaluate(r->load, r->state->xi), direction);
    int upper = fabs(seen - r->branch[branch].keep_to) < fabs(seen - r->branch[branch].keep_from);
    leave_branch(r, upper ? r->branch[branch].keep_to : r->branch[branch].keep_from);
    if (r->count->mode == 0) note_jump(r, 0.0, FOLD), r->state->rate_now = 0.0;
    else r->count->leaving_rest = direction;
}

static double phase_at(Run *r, double xi) {
    return xi >= 1.0 ? r->state->phase_to : r->state->phase_from + xi * (r->state->speed + xi * r->state->bend);
}

static void record(Run *r, double xi_to) {
    double xi = r->state->xi, width = xi_to - xi, phase_from = phase_at(r, xi), phase_to = phase_at(r, xi_to);
    if (phase_to > phase_from) {
        HistoryPiece *kept = r->history + r->count->length;
        kept->trip = r->count->trip, kept->mode = r->count->mode, kept->law_piece = r->count->piece;
        kept->jump = r->count->jump, kept->cause = r->count->cause, kept->echo_of = r->count->echo_of;
        kept->amplified = kept->gain = NAN;
        kept->phase_from = phase_from, kept->phase_to = phase_to;
        kept->speed = (r->state->speed + 2.0 * r->state->bend * xi) * width, kept->bend = r->state->bend * width * width;
        kept->slip = r->state->slip_now, kept->law_slip = r->state->law_slip;
        r->count->length++;
        r->count->jump = r->count->cause = r->count->stalled = 0;
    } else r->count->stalled++;
    r->state->xi = xi_to;
}

static void arrive(Run *r) {
    double load = r->load[0], limit = rest_limit(r);
    int64_t mode = r->count->mode;
    if (mode != 0 && r->count->is_algebraic) {
        double seen = towards(r, load, mode);
        int64_t branch = r->count->branch;
        if (!(r->branch[branch].keep_from <= seen && seen <= r->branch[branch].keep_to)) leave_branch(r, seen);
    } else if (mode != 0 && !r->count->has_inertia) {
        friction_at(r, r->state->law_slip, 0.0);
        if (towards(r, load, mode) < r->friction.stress) r->count->mode = 0;
    }
    if (r->count->mode == 0 && r->count->leaving_rest == 0)
        for (int direction = 1; direction >= -1; direction -= 2)
            if (towards(r, load, direction) > limit) r->count->mode = direction, choose_branch(r, towards(r, load, direction));
    if (r->count->mode == 0) note_jump(r, 0.0, r->count->arriving), r->state->rate_now = 0.0;
}

static void stick(Run *r, double xi_to) {
    double width = xi_to - r->state->xi, limit = rest_limit(r), part[TERMS], onset = NONE;
    double *load = r->history[r->count->length].load, *rate = r->history[r->count->length].rate;
    int direction = 0;
    restrict_to(r->load, r->state->xi, width, load);
    for (int way = 1; way >= -1; way -= 2) {
        for (int k = 0; k < TERMS; k++) part[k] = -way * load[k];
        part[0] = r->count->leaving_rest == way ? 0.0 : limit - towards(r, load[0], way);
        double first = first_descent(part);
        if (first < onset) onset = first, direction = way;
    }
    int slips = onset <= 1.0 - TIE;
    if (slips) {
        double power = onset;
        for (int k = 1; k < TERMS; k++, power *= onset) load[k] *= power;
    }
    memset(rate, 0, TERMS * sizeof(double));
    record(r, slips ? r->state->xi + onset * width : xi_to);
    r->count->leaving_rest = 0;
    if (slips) r->count->mode = r->count->leaving_rest = direction, choose_branch(r, limit);
}

static void come_to_rest(Run *r) {
    int64_t before = r->count->mode;
    r->state->rate_now = 0.0, r->count->mode = 0;
    if (!r->count->has_inertia) { r->count->leaving_rest = before; return; }
    double load = evaluate(r->load, r->state->xi), limit = rest_limit(r);
    for (int direction = 1; direction >= -1; direction -= 2)
        if (towards(r, load, direction) > limit) r->count->mode = direction;
}

/* ---- one Taylor step ------------------------------------------------------------------------------------------------------ */

static double quick_log2(double x) {
    int64_t bits;
    x = fabs(x);
    memcpy(&bits, &x, sizeof bits);
    return bits / 4503599627370496.0 - 1023.0;
}

static double quick_exp2(double x) {
    x = fmin(fmax(x, -1000.0), 1000.0);
    double whole = floor(x), part = x - whole, power;
    int64_t bits = ((int64_t)whole + 1023) << 52;
    memcpy(&power, &bits, sizeof power);
    return power * (1.0 + part * (0.6565 + 0.3435 * part));
}

static double length_at(const double *jet, double tolerance, double expected) {
    double slow = fmax(fabs(jet[0]), expected * fabs(jet[1]));
    double size = fmax(slow, expected * expected * fmax(fabs(jet[2]), expected * fabs(jet[3])));
    int n = TERMS - 1;
    if (jet[n] == 0.0 && jet[n - 1] == 0.0) return INFINITY;
    double allowed = quick_log2(tolerance * size);
    double last = allowed - quick_log2(jet[n]), before = allowed - quick_log2(jet[n - 1]);
    return quick_exp2(fmin(last * (1.0 / n), before * (1.0 / (n - 1))));
}

static double usable_length(const double *jet, double tolerance) {
    double length = length_at(jet, tolerance, 0.5);
    if (length < 0.2)
        for (int i = 0; i < 3; i++) length = length_at(jet, tolerance, length);
    return length;
}

static void series(Run *r, double guess) {
    int64_t direction = r->count->mode, n = r->count->degree;
    SeriesInput *k = &r->k;
    double xi = r->state->xi;
    if (n <= 1) r->local[0] = r->load[0] + xi * r->load[1], r->local[1] = guess * r->load[1], n = 1;
    else restrict_low(r->load, n, xi, guess, r->local);
    for (int i = 1; i <= n; i++) r->load_along_slip[i] = direction * r->local[i];
    r->load_along_slip[0] = towards(r, r->local[0], direction);
    int edge = r->count->leaving_rest != 0;
    k->damping = r->params->damping, k->normal = r->params->normal, k->inertia = r->params->inertia;
    k->stiffness = r->params->stiffness;
    k->chi = r->params->counts_net == 1.0 ? direction : 1.0;
    k->speed = (r->state->speed + 2.0 * r->state->bend * xi) * guess, k->bend = 2.0 * r->state->bend * guess * guess;
    k->slip = r->state->law_slip + r->law->slip_shift, k->offset = r->law->offset;
    k->rate = fabs(r->state->rate_now), k->free = edge ? 0.0 : 1.0;
    k->force = edge ? r->params->normal * r->params->static_excess : 0.0;
    if (r->count->is_algebraic) k->rate = rate_on_branch(r, r->load_along_slip[0], fabs(r->state->rate_now));
    if (r->count->has_inertia) motion_jet(r->c, (double *)k, r->load_along_slip, r->jet);
    else rate_jet(r->c, (double *)k, r->load_along_slip, r->jet);
}

static void stretch(Run *r, double length, double *restrict rate) {
    powers_of(length, r->powers);
    for (int k = 0; k < TERMS; k++) rate[k] = r->jet[k] * r->powers[k];
}

/* What a step may miss, by Schwarz's lemma on one disc: as in engine/contact_step/certificate.py. */
static double share_on_disc(Run *r, double length, int64_t disc) {
    double powers[TERMS], ratio = RATIOS[disc], first = fabs(r->jet[1]), load = 0.0, slopes = 0.0, missed;
    powers_of(ratio * length, powers);
    double rate = first * powers[1], straight = fabs(r->jet[0]) + 0.5 * rate, bent = 0.5 * fabs(r->jet[0]) + reciprocal[3] * rate;
    for (int n = 2; n < TERMS; n++) {
        double size = fabs(r->jet[n]) * powers[n];
        rate += size, straight += reciprocal[n + 1] * size, bent += reciprocal[n + 2] * size;
        slopes += n * fabs(r->jet[n]) * powers[n - 1];
    }
    for (int n = 1; n <= r->count->degree; n++) load += fabs(r->load_along_slip[n]) * powers[n];
    Ball *ball = &r->ball;
    ball->rate = rate, ball->slip = powers[1] * (fabs(r->k.speed) * straight + fabs(r->k.bend) * powers[1] * bent);
    radii(r->c, r->jet, (double *)ball);
    double force = 1.01 * (r->k.damping * ball->rate + r->k.normal * ball->friction + r->k.stiffness * ball->slip + load);
    double square = length * length, size = fmax(fabs(r->jet[0]), length * first);
    size = fmax(size, fmax(square * fabs(r->jet[2]), square * length * fabs(r->jet[3])));
    if (r->count->has_inertia) missed = length * (fabs(r->k.speed) / r->k.inertia * force + slopes) * SHRUNK_SLOPE[disc];
    else {
        double now[4], resistance = r->k.damping;
        if (r->count->is_algebraic) value(r->c, r->k.slip, r->jet[0], now), resistance += fmax(r->k.normal * now[1], 0.0);
        missed = force / resistance * SHRUNK[disc];
    }
    return missed / fmax(r->params->tolerance * size, 1e-300);
}

static double least_share(Run *r, double length, double share, double enough) {
    int64_t first = r->count->disc;
    for (int way = 1; way >= -1 && r->count->disc == first; way -= 2)
        for (int64_t disc = first + way; 0 <= disc && disc < DISCS && !(share <= enough); disc += way) {
            double other = share_on_disc(r, length, disc);
            if (share <= other && share < 1e100) break;
            share = other, r->count->disc = disc;
        }
    return share;
}

static double proven_length(Run *r, double length) {
    double allowed = r->count->has_inertia ? 1000.0 : 100.0, share = share_on_disc(r, length, r->count->disc);
    for (int attempt = 0; !(share <= allowed); attempt++) {
        if (attempt == 60) abort();
        double enough = attempt == 0 ? allowed * pow(0.9, 1 - TERMS) : allowed;
        if (!(share <= enough)) share = least_share(r, length, share, enough);
        if (!(share <= allowed)) {
            double root = quick_exp2((quick_log2(allowed) - quick_log2(share)) * (1.0 / (TERMS - 1)));
            length *= fmin(fmax(0.98 * root, 0.2), 0.9);
            share = share_on_disc(r, length, r->count->disc);
        }
    }
    return length;
}

/* Whether the contact equation holds at the end of a step, to the tolerance or to rounding. */
static int obeys_contact(Run *r, const double *rate, double length, double grown, double rate_end) {
    double dx = r->k.slip + r->k.chi * grown, load = r->load_along_slip[0], now[4], unbalanced = 0.0, slope = 0.0;
    for (int k = 1; k <= r->count->degree; k++) load += r->powers[k] * r->load_along_slip[k];
    if (r->k.free == 0.0) {
        value(r->c, r->k.slip, 0.0, now);
        unbalanced = r->load_along_slip[0] - r->params->normal * (now[0] + r->law->offset) - r->k.force;
    }
    value(r->c, dx, rate_end, now);
    double friction = now[0] + r->law->offset, normal = r->params->normal, damping = r->params->damping;
    double missing = load - damping * rate_end - normal * friction - unbalanced;
    double terms = r->params->reference + fabs(load) + normal * (fabs(friction) + fabs(now[1] * rate_end) + fabs(now[2] * dx));
    double largest = fmax(fmax(fabs(rate[0]), fabs(rate_end)), fmax(fabs(rate[1]), fmax(fabs(rate[2]), fabs(rate[3]))));
    double size = (r->count->has_inertia ? 300.0 : 10.0) * r->params->tolerance * largest;
    if (!r->count->has_inertia) {
        double resistance = damping + normal * fmax(now[1], 0.0);
        return fabs(missing) / resistance <= size + 1e-14 * terms / resistance;
    }
    for (int k = 1; k < TERMS; k++) slope += k * rate[k];
    double pace = (r->k.speed + r->k.bend * length) * length / r->params->inertia;
    return fabs((missing - r->params->stiffness * grown) * pace - slope) <= size + 1e-14 * terms * pace;
}

static void keep_step(Run *r, double *restrict rate, double length, double to) {
    double direction = r->count->mode, speed = r->k.speed * length, bend = r->k.bend * length * length;
    double grown = speed * integral(rate, 1), rate_end = total(rate), *restrict load = r->history[r->count->length].load;
    if (bend != 0.0) grown += bend * integral(rate, 2);
    if (!obeys_contact(r, rate, length, grown, rate_end)) abort();
    for (int k = 0; k < TERMS; k++) load[k] = r->local[k] * r->powers[k];
    if (r->count->is_block) {
        double straight = direction * r->params->stiffness * speed;
        for (int k = 1; k < TERMS; k++) load[k] -= straight * reciprocal[k] * rate[k - 1];
        r->load[0] -= r->params->stiffness * direction * grown;
    }
    if (direction < 0)
        for (int k = 0; k < TERMS; k++) rate[k] = -rate[k];
    record(r, to);
    r->count->moved = 1, r->count->leaving_rest = 0;
    r->state->slip_now += direction * grown, r->state->law_slip += r->k.chi * grown;
    r->state->rate_now = direction * fmax(rate_end, 0.0);
}

static void slip(Run *r, double xi_to) {
    double target = xi_to;
    int leaves = 0;
    if (r->count->is_algebraic) {
        if (isnan(r->state->exit)) r->state->exit = branch_exit(r);
        if (r->state->exit < xi_to) {
            if (r->state->exit <= r->state->xi) { end_branch(r); return; }
            target = r->state->exit, leaves = 1;
        }
    }
    double now = fabs(r->state->speed + 2.0 * r->state->bend * r->state->xi), left = target - r->state->xi;
    double guess = now > 0.0 ? fmin(left, 2.0 * r->state->last_step / now) : left;
    series(r, guess);
    while (!isfinite(r->jet[TERMS - 1]) && guess > 1e-300) guess *= 1e-3, series(r, guess);
    if (r->state->xi == 0.0 && r->count->arriving != NO_CAUSE) note_jump(r, r->count->mode * r->jet[0], r->count->arriving);
    else if (r->count->leaving_rest != 0 && !r->count->has_inertia) note_jump(r, r->count->mode * r->jet[0], FOLD);

    double limit = left / guess, length = usable_length(r->jet, r->params->tolerance), end = NONE;
    double proven = proven_length(r, fmin(length, limit));
    if (proven < fmin(length, limit)) length = proven;
    r->state->last_step = length * fabs(r->k.speed + 0.5 * r->k.bend * fmin(length, 1.0));
    int reached = length >= limit;
    if (reached) length = limit;
    else if (length > 0.5 * limit) length = 0.5 * limit;
    double *rate = r->history[r->count->length].rate;
    stretch(r, length, rate);
    if (!r->count->is_algebraic && rate[0] <= magnitude(rate)) end = first_descent(rate);
    int rests = end <= 1.0 - TIE;
    if (!rests) end = 1.0;
    double to = reached && end == 1.0 ? target : r->state->xi + end * length * guess;
    if (end < 1.0) length *= end, stretch(r, length, rate);
    keep_step(r, rate, length, to);
    if (rests) come_to_rest(r);
    else if (leaves && (reached || target - r->state->xi < TIE)) end_branch(r);
}

/* ---- the loop ------------------------------------------------------------------------------------------------------------- */

static int next_piece(Run *r) {
    State *state = r->state;
    memset(r->load, 0, sizeof r->load);
    if (r->count->is_block || r->count->trip == 0) {
        int64_t source = r->count->source;
        if (source >= r->loads - 1) return 0;
        const FirstLoad *first = r->first_load + source;
        state->phase_from = first->phase, state->phase_to = first[1].phase;
        state->speed = state->phase_to - state->phase_from, state->bend = 0.0, r->count->echo_of = -1;
        r->load[0] = r->count->is_block && r->count->trip > 0 ? state->load_now : first->load;
        r->load[1] = first->slope * state->speed;
        r->count->arriving = r->count->trip == 0 && source == 0 ? START : NO_CAUSE;
    } else {
        int64_t source = r->count->previous_from + r->count->source;
        if (source >= r->count->previous_to) return 0;
        r->count->echo_of = source;
        const HistoryPiece *left = r->history + source;
        const double *rate = left->rate, *load = left->load;
        state->phase_from = left->phase_from, state->phase_to = left->phase_to;
        state->speed = left->speed, state->bend = left->bend;
        for (int k = 0; k < TERMS; k++) r->load[k] = r->params->reflection * (2.0 * r->params->impedance * rate[k] - load[k]);
        r->load[0] += r->params->inflow;
        r->count->arriving = left->jump && r->params->reflection != 0.0 ? ECHO : NO_CAUSE;
    }
    r->count->source++;
    state->xi = 0.0, state->exit = NAN;
    r->count->degree = degree(r->load);
    memset(r->local, 0, sizeof r->local), memset(r->load_along_slip, 0, sizeof r->load_along_slip);
    if (r->count->arriving != NO_CAUSE) r->count->jump = 1;
    r->count->ready = 1;
    arrive(r);
    return 1;
}

static void end_row(Run *r) {
    if (r->count->is_block) r->state->load_now = total(r->history[r->count->length - 1].load);
    r->count->trip++;
    r->count->previous_from = r->count->trip_from, r->count->previous_to = r->count->trip_from = r->count->length;
    r->count->source = r->count->moved = 0;
}

int64_t advance(Memory *m, int64_t last_trip, double last_phase, int64_t budget) {
    Run run, *r = &run;
    run.params = &m->params, run.state = &m->state, run.count = &m->counts, run.c = m->constants;
    run.law = m->law, run.branch = m->branch_table, run.first_load = m->first_load, run.history = m->history;
    run.branches = m->branches, run.loads = m->loads, run.capacity = m->capacity;
    while (1) {
        if (run.count->length + 8 > run.capacity) return FULL;
        if (run.count->stalled > 200) return STORM;
        if (--budget < 0) return -1;
        if (!run.count->ready) {
            if (run.count->trip > last_trip) return FINISHED;
            if (!next_piece(r)) { end_row(r); continue; }
        }
        State *state = run.state;
        double xi_to = 1.0;
        int is_last = run.count->trip == last_trip && state->phase_to >= last_phase;
        if (is_last && state->phase_to > last_phase) {
            double rest = last_phase - state->phase_from;
            double root = sqrt(fmax(state->speed * state->speed + 4.0 * state->bend * rest, 0.0));
            xi_to = fmin(2.0 * rest / (state->speed + root), 1.0);
        }
        if (state->xi < xi_to) {
            if (run.count->mode == 0) stick(r, xi_to);
            else slip(r, xi_to);
            if (!isfinite(state->rate_now)) return FAILED;
        } else if (is_last) return FINISHED;
        else run.count->ready = 0;
    }
}

/* ---- many runs ------------------------------------------------------------------------------------------------------------ */

/* Members one after the other, as `stickslip.extensions.sweeps.batch` does: the addresses of member n are base[k] + n stride[k], a state and a history
   per thread. params: the problem's numbers, par_stride apart. slip: of each member, from its start to its end. Returns how many did
   not finish. */
int64_t run_members(const int64_t *base, const int64_t *stride, const Memory *lent, const Params *params, int64_t par_stride,
                    const int64_t *branches, const State *state, const Counts *count, const int64_t *last_trip,
                    const double *last_phase, int64_t members, int threads, double *slip) {
    int64_t failed = 0;
#pragma omp parallel num_threads(threads) reduction(+ : failed)
    {
        Memory own = *lent;
        int64_t *addresses = (int64_t *)&own;
        HistoryPiece *history = malloc(own.capacity * sizeof *history);
#pragma omp for schedule(dynamic, 256)
        for (int64_t n = 0; n < members; n++) {
            for (int64_t k = 0; k < ADDRESSES; k++) addresses[k] = base[k] + n * stride[k];
            own.params = params[n * par_stride], own.state = *state, own.counts = *count, own.counts.to_the_end = 1;
            own.history = history, own.branches = branches[n];
            failed += advance(&own, last_trip[n], last_phase[n], INT64_MAX) != FINISHED;
            slip[n] = own.state.slip_now;
        }
        free(history);
    }
    return failed;
}
