/* Radii of elementary functions on a disc, as in engine/series/ball_radii.py. */

static double exp_above(double x) {
    double y = fmax(1.4426950408889634 * x, -1000.0), over = 1e308 * fmax(y - 1000.0, 0.0), whole;
    y = fmin(y, 1000.0), whole = floor(y), y -= whole;
    return 1.005 * ldexp(1.0 + y * (0.6565 + 0.3435 * y), (int)whole) + over;
}

static double exp_radius(double argument, double value, double radius) {
    return fmin(exp_above(argument + radius), 0.5 * (value + 1e-300) * radius * (1.0 + exp_above(radius)));
}

static double sine_radius(double own, double other, double radius) {
    double cosh = 0.5 + 0.5 * exp_above(radius);
    return own * radius * radius * (5.0 + cosh) * (1.0 / 12.0) + other * radius * (2.0 + cosh) * (1.0 / 3.0);
}

static double log_radius(double size, double radius) {
    double x = radius / fmax(size, 1e-300);
    return x * fmax(1.0 - 0.5 * x, 0.5) / fmax(1.0 - x, 1e-300);
}

static double power_radius(double size, double exponent, double logarithm) {
    double growth = exponent * logarithm;
    return 0.5 * (size + 1e-300) * growth * (1.0 + exp_above(growth));
}
