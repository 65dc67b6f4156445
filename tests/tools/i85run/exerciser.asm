; exerciser.asm - runs single instructions over their operands and flags, adds A, F, H and L after
; each to a CRC-32, and compares it with the one expected: a processor test in the style of the
; public ones, for CP/M.
; The expected CRCs are put into GROUPS from outside; here they are 0.
;
; Before the instruction: A = a, B = b, C = not a, HL = b:a, F = f. f comes from FLAGS.
; Groups of two flag values run over all 65536 pairs of a and b, groups of four over all a, b = 0.
BDOS    EQU   5
PAGE    EQU   20H             ; the table of the CRC: four pages, lowest byte first
        ORG   100H
        LXI   SP,STACK
        CALL  TABLE
        LXI   H,GROUPS
GROUP:  SHLD  ENTRY
        MOV   E,M
        INX   H
        MOV   D,M
        INX   H
        MOV   A,D
        ORA   E
        JZ    0               ; no more groups: warm boot
        PUSH  H
        MVI   C,9             ; the name
        CALL  BDOS
        POP   H
        MOV   A,M
        STA   OP
        INX   H
        MOV   A,M
        STA   MASK+1
        INX   H
        MOV   A,M
        STA   KIND
        STA   LEFT
        INX   H
        SHLD  EXPECT
        LXI   H,0FFFFH
        SHLD  CRC
        SHLD  CRC+2
        LXI   H,0
        SHLD  BA
        LXI   H,FLAGS
        SHLD  FLAGAT

CASE:   LHLD  FLAGAT
        MOV   E,M
        LHLD  BA
        MOV   B,H
        MOV   A,L
        CMA
        MOV   C,A
        MOV   D,L
        PUSH  D
        POP   PSW
OP:     NOP                   ; the instruction under test
        SHLD  RESULT+2
        PUSH  PSW
        POP   H
        MOV   A,L
MASK:   ANI   0               ; leaves out what the group does not test
        MOV   L,A
        SHLD  RESULT
        LHLD  CRC
        XCHG
        LHLD  CRC+2
        MOV   B,H
        MOV   C,L
        LDA   RESULT          ; F
        CALL  UPDATE
        LDA   RESULT+1        ; A
        CALL  UPDATE
        LDA   RESULT+2        ; L
        CALL  UPDATE
        LDA   RESULT+3        ; H
        CALL  UPDATE
        XCHG
        SHLD  CRC
        MOV   H,B
        MOV   L,C
        SHLD  CRC+2
        LXI   H,BA
        INR   M               ; next a
        JNZ   CASE
        LDA   KIND
        CPI   4
        JZ    NEXTF
        INX   H
        INR   M               ; next b
        JNZ   CASE
NEXTF:  LHLD  FLAGAT
        INX   H
        SHLD  FLAGAT
        LXI   H,LEFT
        DCR   M
        JNZ   CASE

        LHLD  EXPECT
        LXI   D,CRC
        MVI   B,4
SAME:   LDAX  D
        CMP   M
        JNZ   BAD
        INX   H
        INX   D
        DCR   B
        JNZ   SAME
        LXI   D,PASS
        JMP   SHOW
BAD:    LXI   D,FAIL
SHOW:   MVI   C,9
        CALL  BDOS
        LHLD  ENTRY
        LXI   D,SECOND-GROUPS ; bytes of an entry
        DAD   D
        JMP   GROUP

; CRC-32 of one more byte, in A. The register is BCDE, lowest byte in E.
UPDATE: XRA   E
        MOV   L,A
        MVI   H,PAGE
        MOV   A,M
        XRA   D
        MOV   E,A
        INR   H
        MOV   A,M
        XRA   C
        MOV   D,A
        INR   H
        MOV   A,M
        XRA   B
        MOV   C,A
        INR   H
        MOV   B,M
        RET

; Fills the table: the polynomial EDB88320 (reflected), shifted through bit by bit.
TABLE:  MVI   L,0
ITEM:   LXI   B,0
        MVI   D,0
        MOV   E,L
        MVI   H,8
BIT:    XRA   A
        MOV   A,B
        RAR
        MOV   B,A
        MOV   A,C
        RAR
        MOV   C,A
        MOV   A,D
        RAR
        MOV   D,A
        MOV   A,E
        RAR
        MOV   E,A
        JNC   SHIFTD
        MOV   A,B
        XRI   0EDH
        MOV   B,A
        MOV   A,C
        XRI   0B8H
        MOV   C,A
        MOV   A,D
        XRI   83H
        MOV   D,A
        MOV   A,E
        XRI   20H
        MOV   E,A
SHIFTD: DCR   H
        JNZ   BIT
        MVI   H,PAGE
        MOV   M,E
        INR   H
        MOV   M,D
        INR   H
        MOV   M,C
        INR   H
        MOV   M,B
        INR   L
        JNZ   ITEM
        RET

PASS:   DB    'PASS',13,10,'$'
FAIL:   DB    'FAIL',13,10,'$'
FLAGS:  DB    0,0F7H,1,10H

; An entry: name, opcode, flags that count, number of flag values, expected CRC.
; F7 = S Z K AC P V CY; D5 leaves out K and V where the parts' makers do not agree on them.
GROUPS: DW    NADD
        DB    80H,0F7H,2,0,0,0,0
SECOND: DW    NADC
        DB    88H,0F7H,2,0,0,0,0
        DW    NSUB
        DB    90H,0F7H,2,0,0,0,0
        DW    NSBB
        DB    98H,0F7H,2,0,0,0,0
        DW    NANA
        DB    0A0H,0F7H,2,0,0,0,0
        DW    NXRA
        DB    0A8H,0F7H,2,0,0,0,0
        DW    NORA
        DB    0B0H,0F7H,2,0,0,0,0
        DW    NCMP
        DB    0B8H,0F7H,2,0,0,0,0
        DW    NDAD
        DB    9H,0D5H,2,0,0,0,0
        DW    NINX
        DB    23H,0F7H,2,0,0,0,0
        DW    NDCX
        DB    2BH,0F7H,2,0,0,0,0
        DW    NINR
        DB    3CH,0F7H,4,0,0,0,0
        DW    NDCR
        DB    3DH,0F7H,4,0,0,0,0
        DW    NDAA
        DB    27H,0D5H,4,0,0,0,0
        DW    NRLC
        DB    7H,0D5H,4,0,0,0,0
        DW    NRRC
        DB    0FH,0D5H,4,0,0,0,0
        DW    NRAL
        DB    17H,0D5H,4,0,0,0,0
        DW    NRAR
        DB    1FH,0D5H,4,0,0,0,0
        DW    NCMA
        DB    2FH,0D5H,4,0,0,0,0
        DW    NCMC
        DB    3FH,0D5H,4,0,0,0,0
        DW    0

NADD:   DB    'ADD B  $'
NADC:   DB    'ADC B  $'
NSUB:   DB    'SUB B  $'
NSBB:   DB    'SBB B  $'
NANA:   DB    'ANA B  $'
NXRA:   DB    'XRA B  $'
NORA:   DB    'ORA B  $'
NCMP:   DB    'CMP B  $'
NDAD:   DB    'DAD B  $'
NINX:   DB    'INX H  $'
NDCX:   DB    'DCX H  $'
NINR:   DB    'INR A  $'
NDCR:   DB    'DCR A  $'
NDAA:   DB    'DAA    $'
NRLC:   DB    'RLC    $'
NRRC:   DB    'RRC    $'
NRAL:   DB    'RAL    $'
NRAR:   DB    'RAR    $'
NCMA:   DB    'CMA    $'
NCMC:   DB    'CMC    $'

ENTRY:  DS    2
EXPECT: DS    2
FLAGAT: DS    2
BA:     DS    2               ; a, then b
RESULT: DS    4               ; F, A, L, H
CRC:    DS    4
KIND:   DS    1
LEFT:   DS    1
        DS    64
STACK   EQU   $
