"""Read and write files: solutions as netCDF, catalogues, and time series in the format of rupture modellers."""
