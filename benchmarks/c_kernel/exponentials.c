/* The memory of a half-space after a step, as stickslip.extensions.planar.memory.advanced, real and imaginary parts apart, poles innermost. */
void advance(long waves, long poles, const double *restrict decay, const double *restrict gain, double *restrict memory,
             const double *restrict slip, double *restrict sums)
{
    for (long k = 0; k < waves; k++) {
        const double *d = decay + 2 * k * poles, *g = gain + 2 * k * poles;
        for (int part = 0; part < 2; part++) {
            double *m = memory + 2 * (2 * k + part) * poles, u = slip[2 * k + part], sum = 0.0;
#pragma omp simd reduction(+ : sum)
            for (long p = 0; p < poles; p++) {
                double real = d[p] * m[p] - d[poles + p] * m[poles + p] + g[p] * u;
                m[poles + p] = d[p] * m[poles + p] + d[poles + p] * m[p] + g[poles + p] * u;
                m[p] = real;
                sum += real;
            }
            sums[2 * k + part] = sum;
        }
    }
}
