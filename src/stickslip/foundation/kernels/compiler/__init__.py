"""Make machine code of kernels, by numba. Nothing else imports it; `kernels.code` loads what is made here."""
