"""The explorer: a page in the browser, or in a notebook, where a problem answers while its numbers are moved.

`model` says what is shown, and imports neither Panel nor Bokeh; `page` draws it; `server` opens it to browsers, and runs the work
beside the pages.
"""
