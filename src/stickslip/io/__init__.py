"""Read and write files: solutions as netCDF, catalogues, and time series in the formats of seismologists and rupture modellers."""
