"""Write the functions of friction formulas, and make machine code of them."""
