"""The page of the explorer: controls, linked panels, time, and what is exported. Uses Panel and Bokeh."""
