"""The figures of the package: most modules have `data(...)`, which makes a dataset, and `draw(dataset)`, which draws it."""
