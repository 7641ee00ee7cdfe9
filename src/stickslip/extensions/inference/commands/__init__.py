"""The commands `fit` and `infer`."""
