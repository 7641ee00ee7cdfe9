"""Commands about chains and catalogues."""
