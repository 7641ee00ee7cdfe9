"""What becomes machine code when the package is built."""
