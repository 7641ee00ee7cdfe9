"""What a run gives: values at any time, tables, windows."""
